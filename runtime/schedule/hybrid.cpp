// SPDX-License-Identifier: Apache-2.0
// A sub-model stays with one worker, whose cache holds it, while that worker keeps up; idle workers take over what is
// furthest behind.
#include <algorithm>
#include <numeric>

#include "runtime/schedule/oldest_first.hpp"
#include "runtime/schedule/policies.hpp"

namespace moraine::runtime {
namespace {

/// Contiguous blocks of sub-models with about the same predicted work for each worker.
std::vector<std::size_t> home_workers(const StepGraph& graph, std::size_t workers) {
  const double total = std::accumulate(graph.cost.begin(), graph.cost.end(), 0.0);
  std::vector<std::size_t> home(graph.sub_models);
  double before = 0;
  for (std::size_t s = 0; s < graph.sub_models; ++s) {
    const auto first = graph.cost.begin() + graph.node(s, 0);
    const double own = std::accumulate(first, first + static_cast<std::ptrdiff_t>(graph.stages.size()), 0.0);
    const auto worker = static_cast<std::size_t>((before + own / 2) / total * static_cast<double>(workers));
    home[s] = std::min(worker, workers - 1);
    before += own;
  }
  return home;
}

class Hybrid final : public Scheduler {
 public:
  void begin(const StepGraph& graph, int workers, std::int64_t) override {
    graph_ = &graph;
    queues_.assign(static_cast<std::size_t>(workers), {});
    home_ = home_workers(graph, queues_.size());
  }

  void ready(Task task, int) override { queues_[home_[graph_->place(task.node)]].push(*graph_, task); }

  std::optional<Task> next(int worker) override {
    OldestFirst& own = queues_[static_cast<std::size_t>(worker)];
    if (!own.empty()) return own.pop();
    const auto oldest = std::min_element(queues_.begin(), queues_.end(), more_urgent);
    if (oldest->empty()) return std::nullopt;
    return oldest->pop();
  }

 private:
  static bool more_urgent(const OldestFirst& a, const OldestFirst& b) {
    if (a.empty() || b.empty()) return !a.empty() && b.empty();
    return a.top_position() != b.top_position() ? a.top_position() < b.top_position() : a.size() > b.size();
  }

  const StepGraph* graph_ = nullptr;
  std::vector<OldestFirst> queues_;  ///< per home worker
  std::vector<std::size_t> home_;    ///< per sub-model
};

}  // namespace

std::unique_ptr<Scheduler> make_hybrid() { return std::make_unique<Hybrid>(); }

}  // namespace moraine::runtime
