// SPDX-License-Identifier: Apache-2.0
// The contract of a schedulable unit of work and of the model it is cut from. Knows no physics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
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
  virtual void save(std::vector<std::byte>& out) const = 0;
  virtual void load(std::span<const std::byte> in) = 0;
};

/// A set of sub-models that together are one model.
class Model {
 public:
  virtual ~Model() = default;
  virtual std::span<const Stage> stages() const = 0;
  virtual std::size_t size() const = 0;
  virtual SubModel& sub_model(SubModelId id) = 0;
  /// Called between epochs while nothing runs: settles neighbours, may move work between sub-models. Returns how many
  /// rounds the neighbours hold, at least 1 and at most `at_most`. Must not depend on threads, ranks or time.
  virtual std::int64_t begin_epoch(std::int64_t next_round, std::int64_t at_most) = 0;
};

}  // namespace moraine::runtime
