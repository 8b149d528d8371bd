// SPDX-License-Identifier: Apache-2.0
#include "runtime/schedule/executor.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/run_error.hpp"
#include "runtime/schedule/dispatcher.hpp"
#include "runtime/schedule/oldest_first.hpp"
#include "runtime/trace/processor_time.hpp"

namespace moraine::runtime {
namespace {

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
  Run(Executor& owner, const StepGraph& graph, const Epoch& epoch, const Work& work, TaskObserver* observer,
      const Poll& poll)
      : clock_(owner.options_.clock),
        options_(owner.options_),
        graph_(graph),
        epoch_(epoch),
        work_(work),
        observer_(observer),
        poll_(graph.awaits_messages ? poll : Poll{}),
        dispatcher_(*owner.scheduler_, graph, owner.workers_, epoch.rounds_with_opening()),
        load_(graph, owner.workers_),
        in_hand_(static_cast<std::size_t>(owner.workers_)),
        idle_since_(static_cast<std::size_t>(owner.workers_), clock_.now()),
        present_(static_cast<std::size_t>(owner.workers_), false) {}

  /// Called inside the arena.
  void all() {
    const double begin = clock_.now();
    start(begin);
    for (int worker = 1; worker < static_cast<int>(in_hand_.size()); ++worker)
      group_.run([this, worker] { serve(worker); });
    serve(0);
    group_.wait();
    const std::lock_guard lock(mutex_);  // all have ended: for race detectors, which cannot see how oneTBB waits
    const double end = clock_.now(), last = *std::max_element(idle_since_.begin(), idle_since_.end());
    for (std::size_t w = 0; w < idle_since_.size(); ++w) load_.waits[w] += wait_after(idle_since_[w], last, end);
    load_.elapsed = end - begin;
  }

  LoadRecord result() {
    if (broken_) std::rethrow_exception(broken_);
    if (elsewhere_ && !failed_) std::rethrow_exception(elsewhere_);
    if (failed_)
      throw RunError({0, stage_name(first_failed_), graph_.sub_model(first_failed_.node), round(first_failed_),
                      what_of(failed_), 0},
                     failed_);
    return std::move(load_);
  }

 private:
  /// A task from being assigned until it starts.
  struct InHand {
    Task task;
    Released released;
    double handed = 0;
  };

  /// A task that was run.
  struct Ended {
    InHand given;
    int worker;
    double start;
    double end;
    double processor;
    std::exception_ptr error;

    Taken taken() const { return {end - start, processor}; }
  };

  void start(double now) {
    const std::lock_guard lock(mutex_);
    std::fill(idle_since_.begin(), idle_since_.end(), now);
    dispatcher_.start(starting_, now);
    hand_out(now);
  }

  /// A thread that oneTBB lends does a worker's tasks until all are done. Workers for which no thread has come yet are
  /// served by the others.
  void serve(int worker) {
    std::unique_lock<std::mutex> lock = first_lock();
    present_[static_cast<std::size_t>(worker)] = true;
    while (!over()) {
      if (const std::optional<int> next = next_in_hand(worker))
        run(*next, lock);
      else if (poll_ && !watched_)
        watch(worker, lock);
      else
        changed_.wait(lock);
    }
    changed_.notify_all();
  }

  // Not inlined, so that the race detector's list of known reports can name it.
  [[gnu::noinline]] std::unique_lock<std::mutex> first_lock() { return std::unique_lock(mutex_); }

  bool over() const { return dispatcher_.done() || dispatcher_.stopped(); }

  /// A worker that has a task and that the thread of `own` may serve.
  std::optional<int> next_in_hand(int own) const {
    if (in_hand_[static_cast<std::size_t>(own)]) return own;
    for (std::size_t w = 0; w < in_hand_.size(); ++w)
      if (in_hand_[w] && !present_[w]) return static_cast<int>(w);
    return std::nullopt;
  }

  /// Does the work unlocked.
  void run(int worker, std::unique_lock<std::mutex>& lock) {
    const InHand given = *std::exchange(in_hand_[static_cast<std::size_t>(worker)], std::nullopt);
    lock.unlock();
    const Ended ended = attempt(given, worker);
    if (observer_ && !ended.error) observer_->task_done(record_of(ended));
    lock.lock();
    account(ended);
    dispatch(ended);
    hand_out(ended.end);
    if (!watched_) receive();
  }

  /// One thread without a task looks for messages, until it gets a task or all is over.
  void watch(int worker, std::unique_lock<std::mutex>& lock) {
    watched_ = true;
    for (int vain = 0;; ++vain) {
      if (receive()) vain = 0;
      if (over() || next_in_hand(worker)) break;
      lock.unlock();
      rest(vain);
      lock.lock();
    }
    watched_ = false;
    changed_.notify_all();
  }

  /// More threads than cores must not take turns at looking: after a while without messages the watcher sleeps, where
  /// cores are shared the longer the longer it has waited, by about a tenth of that.
  void rest(int vain) const {
    constexpr int before_sleep = 30, shortest = 20, longest = 1000;  // looks, microseconds
    const int longer = options_.shared_cores ? 5 * (vain - before_sleep) : 0;
    if (vain < before_sleep)
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(std::chrono::microseconds(std::min(longest, shortest + longer)));
  }

  /// What messages from elsewhere release. True if anything starts.
  bool receive() {
    if (!poll_) return false;
    arrived_.clear();
    try {
      poll_(arrived_);
    } catch (...) {
      dispatcher_.stop();
      if (!elsewhere_) elsewhere_ = std::current_exception();
    }
    if (arrived_.empty()) return false;
    const double now = clock_.now();
    for (const Arrival& a : arrived_) dispatcher_.arrived(a.task, starting_, released_by(a, now));
    return hand_out(now);
  }

  Released released_by(const Arrival& a, double now) const {
    const bool before = a.sent_in >= graph_.stage(a.task.node);
    return {Release::message, before, static_cast<std::int16_t>(a.sent_in), a.from, a.sent_at, now};
  }

  /// Puts what starts in the hands of workers. True if anything starts. A task that ended at `now` may have waited for
  /// the lock while a message released what it now starts.
  bool hand_out(double now) {
    if (starting_.empty()) return false;
    for (const Assignment& a : starting_)
      in_hand_[static_cast<std::size_t>(a.worker)] = {a.task, a.released, std::max(now, a.released.ready)};
    starting_.clear();
    changed_.notify_all();
    return true;
  }

  Ended attempt(const InHand& given, int worker) const {
    Ended ended{given, worker, clock_.now(), 0, 0, nullptr};
    const double before = options_.processor_time ? processor_seconds() : 0;
    try {
      work_(given.task, worker);
    } catch (...) {
      ended.error = std::current_exception();
    }
    ended.processor = options_.processor_time ? processor_seconds() - before : 0;
    ended.end = clock_.now();
    if (!options_.processor_time) ended.processor = ended.end - ended.start;
    return ended;
  }

  void account(const Ended& e) {
    if (e.error) return keep_first(e.given.task, e.error);
    load_.add(graph_, e.given.task, e.worker, e.taken());
    double& idle_since = idle_since_[static_cast<std::size_t>(e.worker)];
    load_.waits[static_cast<std::size_t>(e.worker)] +=
        wait_before(idle_since, e.given.released, e.given.handed, e.start);
    idle_since = e.end;
  }

  TaskRecord record_of(const Ended& e) const {
    const Released& by = e.given.released;
    TaskRecord r;
    r.start = e.start;
    r.end = e.end;
    r.sent = by.sent;
    r.ready = by.ready;
    r.handed = e.given.handed;
    r.round = round(e.given.task).number;
    r.in_epoch = static_cast<std::int32_t>(e.given.task.round);
    r.sub_model = graph_.sub_model(e.given.task.node);
    r.released_by = by.sub_model;
    r.worker = static_cast<std::int16_t>(e.worker);
    r.stage = static_cast<std::int16_t>(graph_.stage(e.given.task.node));
    r.released_stage = by.stage;
    r.release = by.by;
    r.released_before = by.before;
    r.processor = static_cast<float>(e.processor);
    return r;
  }

  void keep_first(Task task, const std::exception_ptr& error) {
    dispatcher_.stop();
    if (failed_ && !before(task, first_failed_)) return;
    failed_ = error;
    first_failed_ = task;
  }

  /// An error of the policy must not leave a oneTBB task.
  void dispatch(const Ended& ended) {
    try {
      dispatcher_.finish(ended.given.task, ended.worker, starting_, ended.end);
    } catch (...) {
      dispatcher_.stop();
      starting_.clear();
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

  const RunClock clock_;
  const ExecutorOptions& options_;
  const StepGraph& graph_;
  const Epoch epoch_;
  const Work& work_;
  TaskObserver* observer_;
  const Poll poll_;  ///< empty if no messages are awaited

  std::mutex mutex_;
  Dispatcher dispatcher_;
  LoadRecord load_;
  std::vector<std::optional<InHand>> in_hand_;  ///< per worker
  std::vector<double> idle_since_;              ///< per worker
  std::vector<bool> present_;                   ///< per worker: a thread has come for it
  std::condition_variable changed_;             ///< a task is in hand, nobody watches, or all is over
  bool watched_ = false;                        ///< a thread looks for messages
  std::vector<Assignment> starting_;            ///< buffer
  std::vector<Arrival> arrived_;                ///< buffer
  std::exception_ptr elsewhere_;                ///< what looking for messages threw
  std::exception_ptr broken_;                   ///< the policy's
  std::exception_ptr failed_;                   ///< the first failed task's
  Task first_failed_;
  tbb::task_group group_;
};

Executor::Executor(int workers, std::unique_ptr<Scheduler> scheduler, const ExecutorOptions& options)
    : workers_(workers), options_(options), scheduler_(std::move(scheduler)) {
  if (workers < 1) throw std::invalid_argument("an executor needs at least one worker");
  threads_ = std::make_unique<Threads>(workers);
}

Executor::~Executor() = default;

LoadRecord Executor::run(const StepGraph& graph, const Epoch& epoch, const Work& work, TaskObserver* observer,
                         const Poll& poll) {
  Run run(*this, graph, epoch, work, observer, poll);
  threads_->arena.execute([&] { run.all(); });
  return run.result();
}

}  // namespace moraine::runtime
