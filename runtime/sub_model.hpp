// SPDX-License-Identifier: Apache-2.0
// The contract of a schedulable unit of work and of the model it is cut from. Knows no physics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace moraine::runtime {

using SubModelId = std::uint32_t;

/// A stage is one task per sub-model and round. `receives` is the index of the stage whose messages it consumes, or
/// none. Messages of an earlier stage are those of this round; of the same or a later stage, those of the round before.
struct Stage {
  static constexpr int none = -1;
  std::string_view name;
  int receives = none;
};

/// One pass through all stages. Rounds are grouped in epochs; between epochs sub-models may gain and lose neighbours.
struct Round {
  std::int64_t number =
      0;  ///< counted over the whole run; the opening round of an epoch has the number of the next one
  std::int64_t in_epoch =
      0;  ///< 0: the opening round, in which sub-models only exchange what the first real round needs

  /// No messages of an earlier round exist and nothing must advance.
  bool opening() const { return in_epoch == 0; }
};

/// A task's letter box. What was received stays valid until the task returns.
class Port {
 public:
  virtual ~Port() = default;
  /// Errors: std::logic_error if `from` is not among the stage's sources.
  virtual std::span<const std::byte> received(SubModelId from) const = 0;
  /// At most one message per target and stage. Errors: std::logic_error if `to` is not among the stage's targets.
  virtual void send(SubModelId to, std::span<const std::byte> bytes) = 0;
};

/// A unit of work. The runtime never runs two tasks of one sub-model at once, and runs stages in order.
class SubModel {
 public:
  virtual ~SubModel() = default;
  /// Sub-models whose messages `stage` consumes, ascending. Fixed during an epoch.
  virtual std::span<const SubModelId> sources(int stage) const = 0;
  /// Sub-models that `stage` sends to, ascending. Mirrors sources(): a lists b here if b's receiving stage lists a.
  virtual std::span<const SubModelId> targets(int stage) const = 0;
  /// Does the stage's work. What it computes may depend on its own state and the messages only.
  virtual void run(int stage, const Round& round, Port& port) = 0;
  /// Work of a stage in the last round, counted not clocked: predictions made from it are the same everywhere.
  virtual double counted_work(int stage) const = 0;
  /// What a trace tells of each task: one number for each of the model's counters.
  virtual void count(std::span<std::uint32_t>) const {}
  /// Bytes that it takes, about: what moving it costs follows.
  virtual double memory() const { return 0; }
  /// Exact, between being settled for an epoch and its first round.
  virtual void save(std::vector<std::byte>& out) const = 0;
  virtual void load(std::span<const std::byte> in) = 0;
};

/// Which rank owns which sub-model. Every rank knows all of it.
struct Placement {
  int rank = 0;              ///< this one
  std::vector<int> owner{};  ///< rank of each sub-model; empty: all are here
  bool holds(SubModelId id) const { return owner.empty() || owner[id] == rank; }
};

struct EpochPlan {
  std::int64_t rounds = 1;  ///< that the neighbours hold
  bool fresh = true;        ///< neighbours were settled anew: sub-models may be saved and moved before it is run
};

/// A set of sub-models that together are one model. On several ranks each has a model of its own, which holds the
/// sub-models that this rank owns.
class Model {
 public:
  virtual ~Model() = default;
  virtual std::span<const Stage> stages() const = 0;
  /// Of the whole model, wherever they are.
  virtual std::size_t size() const = 0;
  /// One that is held here.
  virtual SubModel& sub_model(SubModelId id) = 0;
  /// Called between epochs while nothing runs, on all ranks: settles neighbours, may move work between sub-models. At
  /// least 1 and at most `at_most` rounds. Must not depend on threads, ranks or time.
  virtual EpochPlan begin_epoch(std::int64_t next_round, std::int64_t at_most) = 0;
  /// Names of what SubModel::count() counts, at most TaskRecord::max_counters.
  virtual std::span<const std::string_view> counters() const { return {}; }
  /// What is known of all sub-models together, the same on every rank. For checkpoints.
  virtual void save_common(std::vector<std::byte>&) const {}
  virtual void load_common(std::span<const std::byte>) {}

  const Placement& placement() const { return placement_; }
  /// Owners change; what leaves is released, what comes is adopted.
  void place(Placement placement) { placement_ = std::move(placement); }
  /// Those that are here, ascending.
  virtual std::vector<SubModelId> held() const {
    std::vector<SubModelId> ids;
    for (SubModelId id = 0; id < size(); ++id)
      if (placement_.holds(id)) ids.push_back(id);
    return ids;
  }
  virtual void release(SubModelId) {}
  virtual void adopt(SubModelId id, std::span<const std::byte> saved) { sub_model(id).load(saved); }

 private:
  Placement placement_;
};

}  // namespace moraine::runtime
