// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recorded_model.hpp"

#include <numeric>

#include "runtime/replay/rearrange.hpp"

namespace moraine::runtime {

std::span<const SubModelId> RecordedModel::Member::sources(int stage) const {
  const std::size_t n = owner_.node(id_, stage);
  return std::span(owner_.from_).subspan(owner_.first_in_[n], owner_.first_in_[n + 1] - owner_.first_in_[n]);
}

std::span<const SubModelId> RecordedModel::Member::targets(int stage) const {
  const std::size_t n = owner_.node(id_, stage);
  return std::span(owner_.to_).subspan(owner_.first_out_[n], owner_.first_out_[n + 1] - owner_.first_out_[n]);
}

RecordedModel::RecordedModel(const Workload& work, const WorkEpoch& epoch, std::size_t copies)
    : work_(work), epoch_(epoch), messages_(side_by_side(epoch, work.sub_models, copies)) {
  for (std::size_t s = 0; s < work.stages(); ++s)
    stages_.push_back({work.settings.stages[s], work.settings.receives.at(s)});
  const std::size_t size = work.sub_models * copies;
  for (SubModelId id = 0; id < size; ++id) members_.emplace_back(*this, id);
  first_out_.assign(size * stages_.size() + 1, 0);
  first_in_ = first_out_;
  for (const SizedMessage& m : messages_) {
    ++first_out_[node(m.message.from, m.message.sent_in) + 1];
    ++first_in_[node(m.message.to, m.message.read_in) + 1];
    to_.push_back(m.message.to);
  }
  std::partial_sum(first_out_.begin(), first_out_.end(), first_out_.begin());
  std::partial_sum(first_in_.begin(), first_in_.end(), first_in_.begin());
  in_.resize(messages_.size());
  from_.resize(messages_.size());
  // Messages ascend by sender, so senders ascend for each reader.
  std::vector<std::size_t> free(first_in_.begin(), first_in_.end());
  for (std::uint32_t i = 0; i < messages_.size(); ++i) {
    const std::size_t at = free[node(messages_[i].message.to, messages_[i].message.read_in)]++;
    in_[at] = i;
    from_[at] = messages_[i].message.from;
  }
}

void RecordedModel::share_out(const Owners& owners, int ranks) {
  held_.assign(static_cast<std::size_t>(ranks), {});
  for (SubModelId id = 0; id < owners.size(); ++id) held_[static_cast<std::size_t>(owners[id])].push_back(id);
  place({0, owners});
}

void RecordedModel::look_at(int rank) {
  Placement placement = this->placement();
  placement.rank = rank;
  place(std::move(placement));
}

}  // namespace moraine::runtime
