// SPDX-License-Identifier: Apache-2.0
// Why a task did not start earlier: the chain of what had to be over before, backwards in time.
#pragma once

#include <algorithm>
#include <vector>

#include "runtime/trace/task_index.hpp"

namespace moraine::runtime {

enum class SpentOn : std::uint8_t {
  task,       ///< a task ran
  message,    ///< the message of a task was on its way
  scheduling  ///< a task was ready and in nobody's way: scheduler, locks, waking up
};

/// A stretch of time of a chain, and the task that ran, sent or was to start.
struct Segment {
  double start = 0, end = 0;
  SpentOn on = SpentOn::task;
  const TaskRecord* task = nullptr;

  double seconds() const { return end - start; }
};

class Chains {
 public:
  /// The trace must outlive it, its lists sorted. Errors: std::invalid_argument if a task names a rank that is not
  /// there. Cost: sorts the tasks.
  explicit Chains(const Trace& trace);

  /// What had to be over before the task could start, as far back as `until`. Segments follow each other without gaps.
  /// A task that was handed out as soon as it was ready waited for the one that released it; else its scheduler had
  /// waited for the rank's task that ended when it was handed out. What was awaited is taken to be over before, even if
  /// the clocks of two ranks disagree. Cost: at most one step per task of the trace.
  std::vector<Segment> before(const TaskRecord& task, double until) const;
  /// The same with the task itself.
  std::vector<Segment> with(const TaskRecord& task, double until) const;

 private:
  void follow(const TaskRecord& task, double until, std::vector<Segment>& out) const;
  const TaskRecord* awaited(const TaskRecord& task) const;
  const TaskRecord* ended_by(const TaskRecord& task) const;

  TaskIndex index_;
  std::vector<std::vector<const TaskRecord*>> by_end_;  ///< per rank
};

}  // namespace moraine::runtime
