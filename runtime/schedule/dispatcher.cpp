// SPDX-License-Identifier: Apache-2.0
#include "runtime/schedule/dispatcher.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace moraine::runtime {

Dispatcher::Dispatcher(Scheduler& scheduler, const StepGraph& graph, int workers, std::int64_t rounds)
    : scheduler_(scheduler),
      graph_(graph),
      rounds_(rounds),
      awaited_{graph.opening_predecessors, graph.predecessors},
      released_{std::vector<Released>(graph.node_count()), std::vector<Released>(graph.node_count())},
      idle_(static_cast<std::size_t>(workers), true),
      unfinished_(static_cast<std::int64_t>(graph.node_count()) * rounds) {
  if (workers < 1) throw std::invalid_argument("a machine needs at least one worker");
}

void Dispatcher::start(std::vector<Assignment>& out, double now) {
  if (done()) return;
  scheduler_.begin(graph_, static_cast<int>(idle_.size()), rounds_);
  for (NodeId node = 0; node < graph_.node_count(); ++node)
    if (awaited_[0][node] == 0) release({node, 0}, Scheduler::nobody, {.sent = now, .ready = now});
  offer_all(out);
  check_progress();
}

void Dispatcher::finish(Task task, int worker, std::vector<Assignment>& out, double now) {
  --unfinished_;
  --running_;
  idle_[static_cast<std::size_t>(worker)] = true;
  if (stopped_) return;
  scheduler_.finished(task, worker);
  release_successors(task, worker, now);
  offer(worker, out);
  offer_all(out);
  check_progress();
}

void Dispatcher::arrived(Task task, std::vector<Assignment>& out, const Released& released) {
  if (stopped_) return;
  count_down(task, Scheduler::nobody, released);
  offer_all(out);
}

void Dispatcher::release_successors(Task task, int worker, double now) {
  Released released{
      Release::task, false, static_cast<std::int16_t>(graph_.stage(task.node)), graph_.sub_model(task.node), now, now};
  for (const NodeId next : graph_.same_round.of(task.node)) count_down({next, task.round}, worker, released);
  if (task.round + 1 == rounds_) return;
  released.before = true;
  for (const NodeId next : graph_.next_round.of(task.node)) count_down({next, task.round + 1}, worker, released);
}

void Dispatcher::count_down(Task task, int released_by, const Released& released) {
  if (--awaited_[static_cast<std::size_t>(task.round & 1)][task.node] == 0) release(task, released_by, released);
}

void Dispatcher::release(Task task, int released_by, const Released& released) {
  ++ready_;
  released_[static_cast<std::size_t>(task.round & 1)][task.node] = released;
  scheduler_.ready(task, released_by);
}

void Dispatcher::offer(int worker, std::vector<Assignment>& out) {
  if (ready_ == 0 || !idle_[static_cast<std::size_t>(worker)]) return;
  const std::optional<Task> task = scheduler_.next(worker);
  if (!task) return;
  take(*task);
  idle_[static_cast<std::size_t>(worker)] = false;
  out.push_back({*task, worker, released_[static_cast<std::size_t>(task->round & 1)][task->node]});
}

void Dispatcher::offer_all(std::vector<Assignment>& out) {
  for (std::size_t worker = 0; worker < idle_.size() && ready_ > 0; ++worker) offer(static_cast<int>(worker), out);
}

/// The counter starts over for the round after next as soon as the task is handed out; none counts it down before.
void Dispatcher::take(Task task) {
  std::uint32_t& awaited = awaited_[static_cast<std::size_t>(task.round & 1)][task.node];
  if (awaited != 0)
    throw std::logic_error(fmt::format("the scheduler starts {} of sub-model {} in round {}, which is not ready",
                                       graph_.stages[static_cast<std::size_t>(graph_.stage(task.node))],
                                       graph_.sub_model(task.node), task.round));
  awaited = graph_.predecessors[task.node];
  --ready_;
  ++running_;
}

void Dispatcher::check_progress() const {
  if (running_ == 0 && unfinished_ > 0 && !graph_.awaits_messages)
    throw std::logic_error(
        fmt::format("the scheduler starts nothing with {} tasks ready and {} to come", ready_, unfinished_));
}

}  // namespace moraine::runtime
