// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/load.hpp"

#include <algorithm>

namespace moraine::runtime {
namespace {

void merge_lists(std::vector<Busy>& into, const std::vector<Busy>& from) {
  into.resize(std::max(into.size(), from.size()));
  for (std::size_t i = 0; i < from.size(); ++i) {
    into[i].seconds += from[i].seconds;
    into[i].tasks += from[i].tasks;
  }
}

}  // namespace

LoadRecord::LoadRecord(const StepGraph& graph, int worker_count)
    : workers(static_cast<std::size_t>(worker_count)), stages(graph.stages.size()), nodes(graph.node_count()) {}

void LoadRecord::add(const StepGraph& graph, Task task, int worker, double seconds) {
  workers[static_cast<std::size_t>(worker)].add(seconds);
  stages[static_cast<std::size_t>(graph.stage(task.node))].add(seconds);
  nodes[task.node].add(seconds);
}

void LoadRecord::merge(const LoadRecord& other) {
  elapsed += other.elapsed;
  merge_lists(workers, other.workers);
  merge_lists(stages, other.stages);
  merge_lists(nodes, other.nodes);
}

double LoadRecord::busy() const {
  double sum = 0;
  for (const Busy& worker : workers) sum += worker.seconds;
  return sum;
}

std::int64_t LoadRecord::tasks() const {
  std::int64_t sum = 0;
  for (const Busy& worker : workers) sum += worker.tasks;
  return sum;
}

double LoadRecord::utilisation() const {
  const double offered = static_cast<double>(workers.size()) * elapsed;
  return offered > 0 && tasks() > 0 ? busy() / offered : 1.0;
}

double LoadRecord::waiting_fraction() const { return 1.0 - utilisation(); }

double LoadRecord::imbalance() const {
  double most = 0;
  for (const Busy& worker : workers) most = std::max(most, worker.seconds);
  return most > 0 ? most * static_cast<double>(workers.size()) / busy() : 1.0;
}

std::vector<double> LoadRecord::mean_cost() const {
  std::vector<double> cost;
  for (const Busy& node : nodes) cost.push_back(node.tasks > 0 ? node.seconds / static_cast<double>(node.tasks) : 0.0);
  return cost;
}

}  // namespace moraine::runtime
