// SPDX-License-Identifier: Apache-2.0
#include "runtime/schedule/executor.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <chrono>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "runtime/run_error.hpp"
#include "runtime/schedule/dispatcher.hpp"
#include "runtime/schedule/oldest_first.hpp"

namespace moraine::runtime {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration span) { return std::chrono::duration<double>(span).count(); }

}  // namespace

/// Without the control, oneTBB would lend no more threads than cores.
struct Executor::Threads {
  explicit Threads(int workers)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(workers)), arena(workers) {}
  tbb::global_control limit;
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
        current_(static_cast<std::size_t>(owner.workers_)),
        starting_(static_cast<std::size_t>(owner.workers_)) {
    for (auto& list : starting_) list.reserve(starting_.size());
  }

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

  void start() {
    std::vector<Assignment> starting;
    {
      const std::lock_guard lock(mutex_);
      dispatcher_.start(starting);
      for (const Assignment& a : starting) at_hand(a.worker) = a.task;
    }
    for (const Assignment& a : starting) group_.run(Slot{this, a.worker});
  }

  void keep_busy(int worker) {
    Task task = first_task(worker);
    bool more = true;
    while (more) {
      const Clock::time_point begin = Clock::now();
      const std::exception_ptr error = attempt(task, worker);
      more = finish(task, worker, begin, Clock::now(), error);
    }
  }

  Task first_task(int worker) {
    const std::lock_guard lock(mutex_);
    return at_hand(worker);
  }

  std::exception_ptr attempt(Task task, int worker) const {
    try {
      work_(task, worker);
    } catch (...) {
      return std::current_exception();
    }
    return nullptr;
  }

  /// Wakes other workers, and says whether this one goes on with `task`.
  bool finish(Task& task, int worker, Clock::time_point begin, Clock::time_point end, const std::exception_ptr& error) {
    std::vector<Assignment>& starting = starting_[static_cast<std::size_t>(worker)];
    starting.clear();
    {
      const std::lock_guard lock(mutex_);
      record(task, worker, begin, end, error);
      dispatch(task, worker, starting);
      for (const Assignment& a : starting) at_hand(a.worker) = a.task;
    }
    bool more = false;
    for (const Assignment& a : starting) {
      if (a.worker == worker) {
        more = true;
        task = a.task;
      } else {
        group_.run(Slot{this, a.worker});
      }
    }
    return more;
  }

  void record(Task task, int worker, Clock::time_point begin, Clock::time_point end, const std::exception_ptr& error) {
    if (error) return keep_first(task, error);
    load_.add(graph_, task, worker, seconds(end - begin));
    if (observer_)
      observer_->task_done({graph_.stage(task.node), graph_.sub_model(task.node), round(task), worker, begin, end});
  }

  void keep_first(Task task, const std::exception_ptr& error) {
    dispatcher_.stop();
    if (failed_ && !before(task, first_failed_)) return;
    failed_ = error;
    first_failed_ = task;
  }

  /// An error of the policy must not leave a oneTBB task.
  void dispatch(Task task, int worker, std::vector<Assignment>& starting) {
    try {
      dispatcher_.finish(task, worker, starting);
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

  Task& at_hand(int worker) { return current_[static_cast<std::size_t>(worker)]; }
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
  std::vector<Task> current_;                      ///< per worker, from being assigned until it starts
  std::vector<std::vector<Assignment>> starting_;  ///< per worker, its own buffer
  std::exception_ptr broken_;                      ///< the policy's
  std::exception_ptr failed_;                      ///< the first failed task's
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
