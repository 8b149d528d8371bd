// SPDX-License-Identifier: Apache-2.0
// Problems for balancers, and their best solutions by trying all.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "runtime/balance/decision.hpp"
#include "runtime/balance/registry.hpp"

namespace moraine::runtime::test {

/// Sub-models of 1000 bytes that nobody's memory limits, on ranks of speed 1, in blocks by number; no messages.
inline BalanceProblem blocks(std::vector<double> load, int ranks) {
  BalanceProblem problem;
  problem.load = std::move(load);
  problem.bytes.assign(problem.load.size(), 1000.0);
  problem.speed.assign(ranks, 1.0);
  for (std::size_t s = 0; s < problem.load.size(); ++s)
    problem.owner.push_back(static_cast<int>(s * ranks / problem.load.size()));
  return problem;
}

inline std::vector<Traffic> row_traffic(SubModelId size, double bytes = 10) {
  std::vector<Traffic> traffic;
  for (SubModelId s = 1; s < size; ++s) traffic.push_back({s - 1, s, bytes});
  return traffic;
}

inline BalanceProblem row(std::vector<double> load, int ranks) {
  BalanceProblem problem = blocks(std::move(load), ranks);
  problem.traffic = row_traffic(problem.size());
  return problem;
}

/// width * height sub-models, numbered line by line, each with up to four neighbours.
inline BalanceProblem grid(SubModelId width, SubModelId height, int ranks) {
  BalanceProblem problem = blocks(std::vector<double>(width * height, 1.0), ranks);
  for (SubModelId s = 0; s < problem.size(); ++s) {
    if (s % width + 1 < width) problem.traffic.push_back({s, s + 1, 10.0});
    if (s + width < problem.size()) problem.traffic.push_back({s, s + width, 10.0});
  }
  return problem;
}

/// Anything that is well formed: idle sub-models, ranks without any, other speeds, memory limits.
inline BalanceProblem random_problem(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](unsigned end) { return random() % end; };
  BalanceProblem problem;
  const SubModelId size = below(40);
  problem.speed.assign(1 + below(9), 1.0);
  if (below(3) == 0)
    for (double& speed : problem.speed) speed = 0.25 * (1 + below(8));
  double bytes = 0;
  for (SubModelId s = 0; s < size; ++s) {
    problem.load.push_back(below(5) == 0 ? 0.0 : 0.001 * below(1000));
    problem.bytes.push_back(below(7) == 0 ? 0.0 : 1.0 * below(5000));
    problem.owner.push_back(static_cast<int>(below(problem.ranks())));
    bytes += problem.bytes.back();
    for (SubModelId b = s + 1; b < size; ++b)
      if (below(size) < 3) problem.traffic.push_back({s, b, 1.0 * below(100)});
  }
  if (below(4) == 0) problem.memory.assign(problem.ranks(), 2000 + 1.5 * bytes / problem.ranks());
  problem.costs.rounds = 1.0 + below(100);
  return problem;
}

inline double makespan(const BalanceProblem& problem, const Owners& owners) {
  return forecast(problem, owners).makespan;
}

inline double imbalance(const BalanceProblem& problem, const Owners& owners) {
  return forecast(problem, owners).imbalance;
}

/// Tries all ranks ^ sub-models owners.
inline double least_makespan(const BalanceProblem& problem) {
  Owners owners(problem.size(), 0);
  double least = makespan(problem, owners);
  for (std::size_t digit = 0; digit < owners.size();) {
    for (digit = 0; digit < owners.size() && owners[digit] + 1 == problem.ranks(); ++digit) owners[digit] = 0;
    if (digit == owners.size()) break;
    ++owners[digit];
    least = std::min(least, makespan(problem, owners));
  }
  return least;
}

inline Owners plan(std::string_view balancer, const BalanceProblem& problem) {
  return find_balancer(balancer).make({})->plan(problem);
}

inline int moves(const Owners& before, const Owners& after) {
  int count = 0;
  for (std::size_t s = 0; s < before.size(); ++s) count += before[s] != after[s];
  return count;
}

}  // namespace moraine::runtime::test
