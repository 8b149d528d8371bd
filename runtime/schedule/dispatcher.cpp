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
      idle_(static_cast<std::size_t>(workers), true),
      unfinished_(static_cast<std::int64_t>(graph.node_count()) * rounds) {
  if (workers < 1) throw std::invalid_argument("a machine needs at least one worker");
}

void Dispatcher::start(std::vector<Assignment>& out) {
  if (done()) return;
  scheduler_.begin(graph_, static_cast<int>(idle_.size()), rounds_);
  for (NodeId node = 0; node < graph_.node_count(); ++node)
    if (awaited_[0][node] == 0) release({node, 0}, Scheduler::nobody);
  offer_all(out);
  check_progress();
}

void Dispatcher::finish(Task task, int worker, std::vector<Assignment>& out) {
  --unfinished_;
  --running_;
  idle_[static_cast<std::size_t>(worker)] = true;
  if (stopped_) return;
  scheduler_.finished(task, worker);
  release_successors(task, worker);
  offer(worker, out);
  offer_all(out);
  check_progress();
}

void Dispatcher::arrived(Task task, std::vector<Assignment>& out) {
  if (stopped_) return;
  count_down(task, Scheduler::nobody);
  offer_all(out);
}

void Dispatcher::release_successors(Task task, int worker) {
  for (const NodeId next : graph_.same_round.of(task.node)) count_down({next, task.round}, worker);
  if (task.round + 1 == rounds_) return;
  for (const NodeId next : graph_.next_round.of(task.node)) count_down({next, task.round + 1}, worker);
}

void Dispatcher::count_down(Task task, int released_by) {
  if (--awaited_[static_cast<std::size_t>(task.round & 1)][task.node] == 0) release(task, released_by);
}

void Dispatcher::release(Task task, int released_by) {
  ++ready_;
  scheduler_.ready(task, released_by);
}

void Dispatcher::offer(int worker, std::vector<Assignment>& out) {
  if (ready_ == 0 || !idle_[static_cast<std::size_t>(worker)]) return;
  const std::optional<Task> task = scheduler_.next(worker);
  if (!task) return;
  take(*task);
  idle_[static_cast<std::size_t>(worker)] = false;
  out.push_back({*task, worker});
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
