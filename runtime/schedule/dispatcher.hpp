// SPDX-License-Identifier: Apache-2.0
// Turns "this task is done" into "these workers start those tasks", for real and simulated machines alike.
#pragma once

#include <array>
#include <vector>

#include "runtime/schedule/scheduler.hpp"
#include "runtime/trace/wait.hpp"

namespace moraine::runtime {

struct Assignment {
  Task task;
  int worker = 0;
  Released released;
};

/// Counts down predecessors and asks the policy. One call at a time. A node has one counter for odd and one for even
/// rounds: no sub-model is two rounds ahead of one it sends to, see build_step_graph().
class Dispatcher {
 public:
  /// `rounds` includes the opening one. `scheduler` and `graph` must outlive this.
  Dispatcher(Scheduler& scheduler, const StepGraph& graph, int workers, std::int64_t rounds);

  /// Appends what starts first. `now` here and below is the caller's clock, handed back in Assignment::released.
  void start(std::vector<Assignment>& out, double now = 0);
  /// Appends what starts now that `task` is done; what `worker` goes on with, if anything, comes first.
  /// Errors: std::logic_error if the policy hands out a task that is not ready, or nothing while no task runs
  /// and no message is awaited.
  /// Cost: the task's successors, and one question to the policy per idle worker as long as tasks are ready.
  void finish(Task task, int worker, std::vector<Assignment>& out, double now = 0);
  /// A message from elsewhere has come for `task`. Appends what starts now.
  void arrived(Task task, std::vector<Assignment>& out, const Released& released = {});
  /// From now on nothing starts.
  void stop() { stopped_ = true; }
  bool done() const { return unfinished_ == 0; }
  bool stopped() const { return stopped_; }

 private:
  void count_down(Task task, int released_by, const Released& released);
  void release(Task task, int released_by, const Released& released);
  void release_successors(Task task, int worker, double now);
  void offer(int worker, std::vector<Assignment>& out);
  void offer_all(std::vector<Assignment>& out);
  void take(Task task);
  void check_progress() const;

  Scheduler& scheduler_;
  const StepGraph& graph_;
  std::int64_t rounds_;
  std::array<std::vector<std::uint32_t>, 2> awaited_;  ///< predecessors to come, by parity of the round
  std::array<std::vector<Released>, 2> released_;      ///< of those that are ready
  std::vector<bool> idle_;                             ///< per worker
  std::int64_t unfinished_;
  std::int64_t ready_ = 0;
  std::int64_t running_ = 0;
  bool stopped_ = false;
};

}  // namespace moraine::runtime
