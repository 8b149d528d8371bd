// SPDX-License-Identifier: Apache-2.0
#include "runtime/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "runtime/cores.hpp"
#include "runtime/schedule/registry.hpp"

namespace moraine::runtime {

Simulation::Simulation(Model& model, const Options& options, Hooks hooks)
    : model_(model),
      options_(options),
      hooks_(std::move(hooks)),
      executor_(options.threads == 0 ? usable_cores() : options.threads, find_scheduler(options.scheduler).make()),
      transport_(options.check_messages) {}

void Simulation::run(std::int64_t first_round, std::int64_t rounds) {
  const std::int64_t end = first_round + rounds;
  for (std::int64_t next = first_round; next < end;) {
    const Epoch epoch = next_epoch(next, end - next);
    run_epoch(epoch);
    next += epoch.rounds;
    if (hooks_.at_epoch_end) hooks_.at_epoch_end(next);
  }
}

Epoch Simulation::next_epoch(std::int64_t next_round, std::int64_t left) {
  const std::int64_t stop = hooks_.until_next_stop ? hooks_.until_next_stop(next_round) : left;
  if (stop < 1) throw std::logic_error(fmt::format("no round may pass from round {} to the next stop", next_round));
  const std::int64_t at_most = std::min(left, stop);
  const std::int64_t rounds = model_.begin_epoch(next_round, at_most);
  if (rounds < 1 || rounds > at_most)
    throw std::logic_error(fmt::format("an epoch of {} rounds, expected 1 to {}", rounds, at_most));
  return {next_round, rounds};
}

void Simulation::run_epoch(const Epoch& epoch) {
  const StepGraph graph = predicted_graph();
  transport_.begin_epoch(model_);
  last_ = executor_.run(
      graph, epoch, [&](Task task, int) { run_task(graph, epoch, task); }, hooks_.observer);
  load_.merge(last_);
}

StepGraph Simulation::predicted_graph() {
  StepGraph graph = build_step_graph(model_);
  const bool measured = options_.measured_cost && last_.busy() > 0 && last_.nodes.size() == graph.node_count();
  if (measured) graph.cost = last_.mean_cost();
  return graph;
}

void Simulation::run_task(const StepGraph& graph, const Epoch& epoch, Task task) {
  const SubModelId id = graph.sub_model(task.node);
  const int stage = graph.stage(task.node);
  Port& port = transport_.open(id, stage, task.round);
  model_.sub_model(id).run(stage, epoch.round(task.round), port);
  transport_.close(id);
}

}  // namespace moraine::runtime
