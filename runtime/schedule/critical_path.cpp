// SPDX-License-Identifier: Apache-2.0
// The task with the longest chain of predicted work behind it goes first, whoever is idle.
#include <algorithm>
#include <queue>

#include "runtime/schedule/policies.hpp"

namespace moraine::runtime {
namespace {

/// Longest chains of an epoch: a node's length far from the end, and how much each round adds to the longest.
struct ChainLengths {
  std::vector<double> level;
  double per_round = 0;
};

/// The level of one node, from those of later stages in this round and of the round after.
double level_of(const StepGraph& graph, NodeId node, const std::vector<double>& level,
                const std::vector<double>& after) {
  double longest = 0;
  for (const NodeId next : graph.same_round.of(node)) longest = std::max(longest, level[next]);
  for (const NodeId next : graph.next_round.of(node)) longest = std::max(longest, after[next]);
  return graph.cost[node] + longest;
}

void add_round_before(const StepGraph& graph, std::vector<double>& level, std::vector<double>& after) {
  after.swap(level);
  for (int stage = static_cast<int>(graph.stages.size()) - 1; stage >= 0; --stage)
    for (std::size_t s = 0; s < graph.sub_models; ++s)
      level[graph.node(s, stage)] = level_of(graph, graph.node(s, stage), level, after);
}

/// Levels settle to a fixed profile that grows evenly, so a few rounds stand for all. Cost: links times those rounds.
ChainLengths chain_lengths(const StepGraph& graph, std::int64_t rounds) {
  constexpr std::int64_t enough = 8;
  ChainLengths out;
  out.level.assign(graph.node_count(), 0.0);
  std::vector<double> after = out.level;
  for (std::int64_t r = 0; r < std::min(rounds, enough); ++r) add_round_before(graph, out.level, after);
  for (NodeId n = 0; n < graph.node_count(); ++n) out.per_round = std::max(out.per_round, out.level[n] - after[n]);
  return out;
}

class CriticalPath final : public Scheduler {
 public:
  void begin(const StepGraph& graph, int, std::int64_t rounds) override {
    chains_ = chain_lengths(graph, rounds);
    rounds_ = rounds;
    heap_ = {};
  }

  void ready(Task task, int) override {
    const double rest = static_cast<double>(rounds_ - task.round) * chains_.per_round;
    heap_.push({rest + chains_.level[task.node], task});
  }

  std::optional<Task> next(int) override {
    if (heap_.empty()) return std::nullopt;
    const Task task = heap_.top().task;
    heap_.pop();
    return task;
  }

 private:
  struct Entry {
    double chain;
    Task task;
    bool operator<(const Entry& other) const {  // the heap's top is its largest
      if (chain != other.chain) return chain < other.chain;
      return task.round != other.task.round ? task.round > other.task.round : task.node > other.task.node;
    }
  };

  ChainLengths chains_;
  std::int64_t rounds_ = 0;
  std::priority_queue<Entry> heap_;
};

}  // namespace

std::unique_ptr<Scheduler> make_critical_path() { return std::make_unique<CriticalPath>(); }

}  // namespace moraine::runtime
