// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/load.hpp"

#include <algorithm>

#include "runtime/records.hpp"

namespace moraine::runtime {
namespace {

void merge_lists(std::vector<Busy>& into, const std::vector<Busy>& from) {
  into.resize(std::max(into.size(), from.size()));
  for (std::size_t i = 0; i < from.size(); ++i) {
    into[i].add(from[i].taken, from[i].tasks);
  }
}

}  // namespace

LoadRecord::LoadRecord(const StepGraph& graph, int worker_count)
    : workers(static_cast<std::size_t>(worker_count)),
      waits(static_cast<std::size_t>(worker_count)),
      stages(graph.stages.size()),
      nodes(graph.ids.empty() ? 0 : (graph.ids.back() + 1) * graph.stages.size()) {}

void LoadRecord::add(const StepGraph& graph, Task task, int worker, const Taken& taken) {
  workers[static_cast<std::size_t>(worker)].add(taken);
  stages[static_cast<std::size_t>(graph.stage(task.node))].add(taken);
  nodes[graph.sub_model(task.node) * graph.stages.size() + static_cast<std::size_t>(graph.stage(task.node))].add(taken);
}

void LoadRecord::merge(const LoadRecord& other) {
  elapsed += other.elapsed;
  merge_lists(workers, other.workers);
  waits.resize(std::max(waits.size(), other.waits.size()));
  for (std::size_t w = 0; w < other.waits.size(); ++w) waits[w] += other.waits[w];
  merge_lists(stages, other.stages);
  merge_lists(nodes, other.nodes);
}

double LoadRecord::busy() const {
  double sum = 0;
  for (const Busy& worker : workers) sum += worker.taken.seconds;
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
  double most = 0, sum = 0;
  for (const Busy& worker : workers) {
    most = std::max(most, worker.taken.processor);
    sum += worker.taken.processor;
  }
  return most > 0 ? most * static_cast<double>(workers.size()) / sum : 1.0;
}

double LoadRecord::processor_of(SubModelId id) const {
  double sum = 0;
  for (std::size_t stage = 0; stage < stages.size(); ++stage)
    if (const std::size_t at = id * stages.size() + stage; at < nodes.size()) sum += nodes[at].taken.processor;
  return sum;
}

std::vector<double> LoadRecord::mean_cost(const StepGraph& graph) const {
  std::vector<double> cost;
  for (NodeId node = 0; node < graph.node_count(); ++node) {
    const std::size_t at = graph.sub_model(node) * stages.size() + static_cast<std::size_t>(graph.stage(node));
    const Busy busy = at < nodes.size() ? nodes[at] : Busy{};
    cost.push_back(busy.tasks > 0 ? busy.taken.seconds / static_cast<double>(busy.tasks) : 0.0);
  }
  return cost;
}

LoadRecord all_ranks(const LoadRecord& own, Transport& transport) {
  Bytes told;
  write_records(told, std::vector{own.elapsed});
  for (const auto* list : {&own.workers, &own.stages, &own.nodes}) write_records(told, *list);
  write_records(told, own.waits);
  LoadRecord all;
  for (const Bytes& bytes : transport.all_gather(told)) {
    std::span<const std::byte> in(bytes);
    all.elapsed = std::max(all.elapsed, read_records<double>(in).at(0));
    const auto workers = read_records<Busy>(in);
    all.workers.insert(all.workers.end(), workers.begin(), workers.end());
    merge_lists(all.stages, read_records<Busy>(in));
    merge_lists(all.nodes, read_records<Busy>(in));
    const auto waits = read_records<Wait>(in);
    all.waits.insert(all.waits.end(), waits.begin(), waits.end());
  }
  return all;
}

}  // namespace moraine::runtime
