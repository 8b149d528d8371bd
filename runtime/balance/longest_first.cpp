// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/longest_first.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "runtime/balance/relabel.hpp"

namespace moraine::runtime {
namespace {

std::vector<SubModelId> by_falling_load(const std::vector<double>& load) {
  std::vector<SubModelId> order(load.size());
  std::iota(order.begin(), order.end(), SubModelId{0});
  std::stable_sort(order.begin(), order.end(), [&](SubModelId a, SubModelId b) { return load[a] > load[b]; });
  return order;
}

/// Bytes by which a rank would exceed its limit.
double excess(const BalanceProblem& problem, int rank, double bytes) {
  return problem.memory.empty() ? 0.0 : std::max(0.0, bytes - problem.memory[rank]);
}

}  // namespace

Owners longest_first(const BalanceProblem& problem) {
  std::vector<double> load(problem.ranks(), 0.0), bytes(problem.ranks(), 0.0);
  Owners owners(problem.size());
  for (const SubModelId s : by_falling_load(problem.load)) {
    const auto key = [&](int rank) {
      return std::tuple(excess(problem, rank, bytes[rank] + problem.bytes[s]),
                        (load[rank] + problem.load[s]) / problem.speed[rank], rank);
    };
    int best = 0;
    for (int rank = 1; rank < problem.ranks(); ++rank)
      if (key(rank) < key(best)) best = rank;
    owners[s] = best;
    load[best] += problem.load[s];
    bytes[best] += problem.bytes[s];
  }
  return relabel(problem, owners);
}

}  // namespace moraine::runtime
