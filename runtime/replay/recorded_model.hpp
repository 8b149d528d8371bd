// SPDX-License-Identifier: Apache-2.0
// A traced epoch as a model: it says what its sub-models said, and computes nothing.
#pragma once

#include <vector>

#include "runtime/replay/workload.hpp"
#include "runtime/sub_model.hpp"

namespace moraine::runtime {

class RecordedModel final : public Model {
 public:
  /// `work` and `epoch` must outlive it. Copies stand side by side, see side_by_side().
  RecordedModel(const Workload& work, const WorkEpoch& epoch, std::size_t copies);

  std::span<const Stage> stages() const override { return stages_; }
  std::size_t size() const override { return members_.size(); }
  SubModel& sub_model(SubModelId id) override { return members_[id]; }
  EpochPlan begin_epoch(std::int64_t, std::int64_t at_most) override { return {at_most}; }
  std::vector<SubModelId> held() const override { return held_[static_cast<std::size_t>(placement().rank)]; }

  /// Who owns what; then the model of each rank can be looked at in turn.
  void share_out(const Owners& owners, int ranks);
  void look_at(int rank);
  std::size_t held_by(int rank) const { return held_[static_cast<std::size_t>(rank)].size(); }

  const std::vector<SizedMessage>& messages() const { return messages_; }
  std::size_t node(SubModelId id, int stage) const { return id * stages_.size() + static_cast<std::size_t>(stage); }
  /// Places in messages() of those that a node sends: first_sent(n) .. first_sent(n + 1) - 1, ascending by receiver.
  std::size_t first_sent(std::size_t node) const { return first_out_[node]; }
  /// Places in messages() of those that a node reads.
  std::span<const std::uint32_t> read_by(std::size_t node) const {
    return std::span(in_).subspan(first_in_[node], first_in_[node + 1] - first_in_[node]);
  }
  double seconds(SubModelId id, int stage, std::int64_t round) const {
    return epoch_.seconds_of(node(static_cast<SubModelId>(id % work_.sub_models), stage), work_.nodes(), round);
  }
  double memory(SubModelId id) const { return epoch_.memory[id % work_.sub_models]; }
  double cost(SubModelId id, int stage) const {
    return epoch_.cost[node(static_cast<SubModelId>(id % work_.sub_models), stage)];
  }

 private:
  class Member final : public SubModel {
   public:
    Member(const RecordedModel& owner, SubModelId id) : owner_(owner), id_(id) {}
    std::span<const SubModelId> sources(int stage) const override;
    std::span<const SubModelId> targets(int stage) const override;
    double counted_work(int stage) const override { return owner_.cost(id_, stage); }
    double memory() const override { return owner_.memory(id_); }
    void run(int, const Round&, Port&) override {}
    void save(std::vector<std::byte>&) const override {}
    void load(std::span<const std::byte>) override {}

   private:
    const RecordedModel& owner_;
    SubModelId id_;
  };

  const Workload& work_;
  const WorkEpoch& epoch_;
  std::vector<Stage> stages_;
  std::vector<Member> members_;
  std::vector<SizedMessage> messages_;
  std::vector<std::size_t> first_out_, first_in_;  ///< per node
  std::vector<SubModelId> to_;                     ///< per message
  std::vector<std::uint32_t> in_;                  ///< messages by reader
  std::vector<SubModelId> from_;                   ///< per entry of in_
  std::vector<std::vector<SubModelId>> held_;      ///< per rank
};

}  // namespace moraine::runtime
