// SPDX-License-Identifier: Apache-2.0
// The contract of a scheduling policy: which worker does which ready task next.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/step_graph.hpp"

namespace moraine::runtime {

/// Pure decisions: no threads, no clock, so that a simulated machine is scheduled by the same code as a real one. Its
/// caller lets one call happen at a time. A policy changes when and where a task runs, never what it computes.
class Scheduler {
 public:
  static constexpr int nobody = -1;
  virtual ~Scheduler() = default;
  /// A new epoch of `rounds` rounds, the opening one included. `graph` outlives the epoch.
  virtual void begin(const StepGraph& graph, int workers, std::int64_t rounds) = 0;
  /// `task` may run from now on; `released_by` finished its last predecessor, or nobody did: it had none.
  virtual void ready(Task task, int released_by) = 0;
  /// `task` is done; what it released is told next.
  virtual void finished(Task, int /*worker*/) {}
  /// A ready task for an idle worker, handed out once. None: the worker idles and is asked again when a task finishes.
  /// While no task runs and one is ready, some worker must get one.
  virtual std::optional<Task> next(int worker) = 0;
};

}  // namespace moraine::runtime
