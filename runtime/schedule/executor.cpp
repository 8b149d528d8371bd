// SPDX-License-Identifier: Apache-2.0
#include "runtime/schedule/executor.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <vector>

#include "runtime/run_error.hpp"
#include "runtime/schedule/dispatcher.hpp"
#include "runtime/schedule/oldest_first.hpp"

namespace moraine::runtime {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration span) { return std::chrono::duration<double>(span).count(); }

/// Without this, oneTBB would lend no more threads than cores. It is set once and for all: after a change of the limit
/// oneTBB 2021.8 may leave the next arena without threads.
void allow_more_threads_than_cores() {
  static const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 256);
}

}  // namespace

struct Executor::Threads {
  explicit Threads(int workers) : arena(workers) { allow_more_threads_than_cores(); }
  tbb::task_arena arena;
};

/// One call of run(). Everything but the work itself happens under the mutex, which thereby hands each task's results
/// to its successors.
class Executor::Run {
 public:
  Run(Executor& owner, const StepGraph& graph, const Epoch& epoch, const Work& work, TaskObserver* observer)
      : graph_(graph),
        epoch_(epoch),
        work_(work),
        observer_(observer),
        dispatcher_(*owner.scheduler_, graph, owner.workers_, epoch.rounds_with_opening()),
        load_(graph, owner.workers_),
        current_(static_cast<std::size_t>(owner.workers_)) {}

  /// Called inside the arena.
  void all() {
    const Clock::time_point begin = Clock::now();
    start();
    group_.wait();
    const std::lock_guard lock(mutex_);
    load_.elapsed = seconds(Clock::now() - begin);
  }

  LoadRecord result() {
    if (broken_) std::rethrow_exception(broken_);
    if (failed_)
      throw RunError(stage_name(first_failed_), graph_.sub_model(first_failed_.node), round(first_failed_), failed_);
    return std::move(load_);
  }

 private:
  /// What oneTBB runs: a worker from its task at hand until nothing is left for it.
  struct Slot {
    Run* run;
    int worker;
    void operator()() const { run->keep_busy(worker); }
  };

  /// A task that was run.
  struct Ended {
    Task task;
    int worker;
    Clock::time_point begin;
    Clock::time_point end;
    std::exception_ptr error;
  };

  void start() {
    std::vector<Assignment> starting;
    {
      const std::lock_guard lock(mutex_);
      dispatcher_.start(starting);
      put_at_hand(starting);
    }
    wake(starting, Scheduler::nobody);
  }

  void keep_busy(int worker) {
    std::vector<Assignment> starting;  // this call's: the worker may be busy again before it returns
    std::optional<Task> task = first_task(worker);
    while (task) {
      const Ended ended = attempt(*task, worker);
      starting.clear();
      settle(ended, starting);
      task = wake(starting, worker);
    }
  }

  // Not inlined, so that the race detector's list of known reports can name it.
  [[gnu::noinline]] Task first_task(int worker) {
    const std::lock_guard lock(mutex_);
    return current_[static_cast<std::size_t>(worker)];
  }

  Ended attempt(Task task, int worker) const {
    Ended ended{task, worker, Clock::now(), {}, nullptr};
    try {
      work_(task, worker);
    } catch (...) {
      ended.error = std::current_exception();
    }
    ended.end = Clock::now();
    return ended;
  }

  void settle(const Ended& ended, std::vector<Assignment>& starting) {
    const std::lock_guard lock(mutex_);
    record(ended);
    dispatch(ended, starting);
    put_at_hand(starting);
  }

  void put_at_hand(const std::vector<Assignment>& starting) {
    for (const Assignment& a : starting) current_[static_cast<std::size_t>(a.worker)] = a.task;
  }

  /// Wakes other workers, and returns what `self` goes on with.
  std::optional<Task> wake(const std::vector<Assignment>& starting, int self) {
    std::optional<Task> own;
    for (const Assignment& a : starting) {
      if (a.worker == self) {
        own = a.task;
      } else {
        group_.run(Slot{this, a.worker});
      }
    }
    return own;
  }

  void record(const Ended& e) {
    if (e.error) return keep_first(e.task, e.error);
    load_.add(graph_, e.task, e.worker, seconds(e.end - e.begin));
    if (observer_)
      observer_->task_done(
          {graph_.stage(e.task.node), graph_.sub_model(e.task.node), round(e.task), e.worker, e.begin, e.end});
  }

  void keep_first(Task task, const std::exception_ptr& error) {
    dispatcher_.stop();
    if (failed_ && !before(task, first_failed_)) return;
    failed_ = error;
    first_failed_ = task;
  }

  /// An error of the policy must not leave a oneTBB task.
  void dispatch(const Ended& ended, std::vector<Assignment>& starting) {
    try {
      dispatcher_.finish(ended.task, ended.worker, starting);
    } catch (...) {
      dispatcher_.stop();
      starting.clear();
      if (!broken_) broken_ = std::current_exception();
    }
  }

  bool before(Task a, Task b) const {
    const std::int64_t position_a = stage_position(graph_, a);
    const std::int64_t position_b = stage_position(graph_, b);
    return position_a != position_b ? position_a < position_b : a.node < b.node;
  }

  Round round(Task task) const { return epoch_.round(task.round); }
  const std::string& stage_name(Task task) const {
    return graph_.stages[static_cast<std::size_t>(graph_.stage(task.node))];
  }

  const StepGraph& graph_;
  const Epoch epoch_;
  const Work& work_;
  TaskObserver* observer_;

  std::mutex mutex_;
  Dispatcher dispatcher_;
  LoadRecord load_;
  std::vector<Task> current_;  ///< per worker, from being assigned until it starts
  std::exception_ptr broken_;  ///< the policy's
  std::exception_ptr failed_;  ///< the first failed task's
  Task first_failed_;
  tbb::task_group group_;
};

Executor::Executor(int workers, std::unique_ptr<Scheduler> scheduler)
    : workers_(workers), scheduler_(std::move(scheduler)) {
  if (workers < 1) throw std::invalid_argument("an executor needs at least one worker");
  threads_ = std::make_unique<Threads>(workers);
}

Executor::~Executor() = default;

LoadRecord Executor::run(const StepGraph& graph, const Epoch& epoch, const Work& work, TaskObserver* observer) {
  Run run(*this, graph, epoch, work, observer);
  threads_->arena.execute([&] { run.all(); });
  return run.result();
}

}  // namespace moraine::runtime
