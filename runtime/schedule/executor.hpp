// SPDX-License-Identifier: Apache-2.0
// Runs a step graph on the threads of this process.
#pragma once

#include <functional>
#include <memory>

#include "runtime/epoch.hpp"
#include "runtime/schedule/scheduler.hpp"
#include "runtime/trace/clock.hpp"
#include "runtime/trace/load.hpp"
#include "runtime/trace/observer.hpp"
#include "runtime/transport/mail.hpp"

namespace moraine::runtime {

struct ExecutorOptions {
  RunClock clock = {};          ///< what times are told by
  bool processor_time = false;  ///< a task's processor time is measured too
  bool shared_cores = false;    ///< there are more threads than cores: those that wait leave them to others
};

/// Workers are numbered slots that run one task at a time; oneTBB lends them threads. There may be more than cores.
class Executor {
 public:
  /// Does the work of a task. Called from several threads; what one task writes its successors see.
  using Work = std::function<void(Task task, int worker)>;
  /// Looks whether messages have come from elsewhere and appends the tasks they are for. Called by one thread at a
  /// time, often. What it throws ends the run.
  using Poll = std::function<void(std::vector<Arrival>& arrived)>;

  /// Errors: std::invalid_argument if workers < 1.
  Executor(int workers, std::unique_ptr<Scheduler> scheduler, const ExecutorOptions& options = {});
  ~Executor();

  int workers() const { return workers_; }

  /// Runs every node of the graph in the opening round and `epoch.rounds` more; returns when all are done. Idle
  /// threads sleep. Errors: if tasks throw, no more are started; when
  /// those running have ended, RunError for the first of the failed by (round, stage, sub-model). std::logic_error if
  /// the policy breaks its contract. While messages are awaited, threads look for them between tasks, and one idle
  /// thread all the time. Cost: a fraction of a microsecond per task beside its work,
  /// one to two more where processor time is measured.
  LoadRecord run(const StepGraph& graph, const Epoch& epoch, const Work& work, TaskObserver* observer = nullptr,
                 const Poll& poll = {});

 private:
  class Run;
  struct Threads;

  int workers_;
  ExecutorOptions options_;
  std::unique_ptr<Scheduler> scheduler_;
  std::unique_ptr<Threads> threads_;
};

}  // namespace moraine::runtime
