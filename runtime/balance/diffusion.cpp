// SPDX-License-Identifier: Apache-2.0
// Work flows from slow ranks to faster ones that own neighbours, as heat does; sub-models at their border carry it.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "runtime/balance/assignment.hpp"
#include "runtime/balance/neighbours.hpp"
#include "runtime/balance/policies.hpp"

namespace moraine::runtime {
namespace {

constexpr int sweeps = 1000;           // a longer way is gone in several turns
constexpr double still_enough = 1e-4;  // of an even load per rank

/// Load that should go from one rank to another.
struct Flow {
  int from = 0;
  int to = 0;
  double load = 0;
};

/// Pairs of ranks that own neighbours, ascending, lower rank first; nothing flows yet.
std::vector<Flow> rank_pairs(const BalanceProblem& problem) {
  std::vector<Flow> pairs;
  for (const Traffic& traffic : problem.traffic) {
    const auto [low, high] = std::minmax(problem.owner[traffic.a], problem.owner[traffic.b]);
    if (low != high) pairs.push_back({low, high, 0.0});
  }
  const auto key = [](const Flow& flow) { return std::pair(flow.from, flow.to); };
  std::ranges::sort(pairs, {}, key);
  const auto rest = std::ranges::unique(pairs, {}, key);
  pairs.erase(rest.begin(), rest.end());
  return pairs;
}

/// Share of a difference in time that flows in a sweep: 1 / (1 + larger number of neighbours) of it (Boillat 1990,
/// Concurrency 2), for ranks of different speed as if all had the lower one.
std::vector<double> conductances(const BalanceProblem& problem, const std::vector<Flow>& pairs) {
  std::vector<int> degree(problem.ranks(), 0);
  for (const Flow& pair : pairs)
    for (const int rank : {pair.from, pair.to}) ++degree[rank];
  std::vector<double> result;
  for (const Flow& p : pairs)
    result.push_back(std::min(problem.speed[p.from], problem.speed[p.to]) /
                     (1.0 + std::max(degree[p.from], degree[p.to])));
  return result;
}

/// First-order diffusion (Cybenko 1989, J. Parallel Distrib. Comput. 7) to near rest. Cost: O(sweeps * pairs).
std::vector<Flow> flows(const BalanceProblem& problem) {
  std::vector<Flow> pairs = rank_pairs(problem);
  const std::vector<double> conductance = conductances(problem, pairs);
  std::vector<double> load(problem.ranks(), 0.0);
  for (SubModelId s = 0; s < problem.size(); ++s) load[problem.owner[s]] += problem.load[s];
  const double rest = still_enough * std::accumulate(load.begin(), load.end(), 0.0) / problem.ranks();
  double largest = 2 * rest;
  for (int sweep = 0; sweep < sweeps && largest > rest; ++sweep) {
    const std::vector<double> before = load;
    largest = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Flow& p = pairs[i];
      const double flow =
          conductance[i] * (before[p.from] / problem.speed[p.from] - before[p.to] / problem.speed[p.to]);
      p.load += flow;
      load[p.from] -= flow;
      load[p.to] += flow;
      largest = std::max(largest, std::abs(flow));
    }
  }
  return pairs;
}

/// Moves whole sub-models along the flows, each at most once, and remembers the best owners on the way.
class Carrier {
 public:
  explicit Carrier(const BalanceProblem& problem)
      : problem_(problem),
        neighbours_(problem),
        state_(problem, problem.owner),
        flows_(flows(problem)),
        moved_(problem.size(), false) {
    for (Flow& flow : flows_)
      if (flow.load < 0) flow = {flow.to, flow.from, -flow.load};
  }

  Owners run() {
    Owners best = state_.owners();
    double makespan = state_.makespan();
    while (carry_one()) {
      if (state_.makespan() >= makespan) continue;
      makespan = state_.makespan();
      best = state_.owners();
    }
    return best;
  }

 private:
  /// Serves the largest flow that any sub-model can serve.
  bool carry_one() {
    std::ranges::stable_sort(flows_, std::greater<>(), &Flow::load);
    for (Flow& flow : flows_) {
      const std::optional<SubModelId> s = best_for(flow);
      if (!s) continue;
      state_.move(*s, flow.to);
      moved_[*s] = true;
      flow.load -= problem_.load[*s];
      if (flow.load < 0) flow = {flow.to, flow.from, -flow.load};
      return true;
    }
    return false;
  }

  /// The sub-model that leaves the least flow; of equals, the one that leaves the fewest messages between ranks.
  std::optional<SubModelId> best_for(const Flow& flow) const {
    std::optional<SubModelId> best;
    std::pair<double, double> least;
    for (const SubModelId s : state_.members(flow.from)) {
      if (!can_carry(s, flow)) continue;
      const std::pair key(std::abs(flow.load - problem_.load[s]), new_messages(s, flow));
      if (best && key >= least) continue;
      least = key;
      best = s;
    }
    return best;
  }

  bool can_carry(SubModelId s, const Flow& flow) const {
    const double load = problem_.load[s];
    return !moved_[s] && load > 0 && load < 2 * flow.load && at_border(s, flow.to) &&
           state_.has_room(flow.to, problem_.bytes[s]);
  }

  bool at_border(SubModelId s, int rank) const {
    return std::ranges::any_of(neighbours_.of(s), [&](const Neighbour& n) { return state_.owners()[n.id] == rank; });
  }

  double new_messages(SubModelId s, const Flow& flow) const {
    return neighbours_.bytes_with(state_.owners(), s, flow.from) - neighbours_.bytes_with(state_.owners(), s, flow.to);
  }

  const BalanceProblem& problem_;
  Neighbours neighbours_;
  Assignment state_;
  std::vector<Flow> flows_;  ///< none negative
  std::vector<bool> moved_;
};

class Diffusion final : public Balancer {
 public:
  Owners plan(const BalanceProblem& problem) const override { return Carrier(problem).run(); }
};

}  // namespace

std::unique_ptr<Balancer> make_diffusion(const BalancerOptions&) { return std::make_unique<Diffusion>(); }

}  // namespace moraine::runtime
