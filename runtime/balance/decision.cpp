// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/decision.hpp"

#include <algorithm>
#include <numeric>

namespace moraine::runtime {
namespace {

std::vector<double> sum_by_rank(const std::vector<double>& amounts, const Owners& owners, int ranks) {
  std::vector<double> sums(ranks, 0.0);
  for (SubModelId s = 0; s < owners.size(); ++s) sums[owners[s]] += amounts[s];
  return sums;
}

double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

void count_moves(const BalanceProblem& problem, BalanceDecision& decision) {
  std::vector<double> busy(problem.ranks(), 0.0);
  for (SubModelId s = 0; s < problem.size(); ++s) {
    if (decision.plan[s] == problem.owner[s]) continue;
    ++decision.moves;
    decision.bytes += problem.bytes[s];
    const double seconds = problem.costs.seconds_per_move + problem.costs.seconds_per_byte * problem.bytes[s];
    for (const int rank : {problem.owner[s], decision.plan[s]}) busy[rank] += seconds;
  }
  decision.cost_seconds = most(busy);
}

bool pays(const BalanceProblem& problem, const BalanceDecision& decision) {
  return decision.gain_seconds > decision.cost_seconds &&
         decision.before.imbalance - decision.after.imbalance > problem.costs.least_imbalance_gain &&
         fits_memory(problem, decision.plan);
}

}  // namespace

double sum(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Forecast forecast(const BalanceProblem& problem, const Owners& owners) {
  std::vector<double> time = sum_by_rank(problem.load, owners, problem.ranks());
  for (int rank = 0; rank < problem.ranks(); ++rank) time[rank] /= problem.speed[rank];
  Forecast result;
  result.makespan = most(time);
  const double ideal = sum(problem.load) / sum(problem.speed);
  if (ideal > 0) result.imbalance = result.makespan / ideal;
  for (const Traffic& traffic : problem.traffic)
    if (owners[traffic.a] != owners[traffic.b]) result.cut_bytes += traffic.bytes;
  return result;
}

bool fits_memory(const BalanceProblem& problem, const Owners& owners) {
  if (problem.memory.empty()) return true;
  const std::vector<double> used = sum_by_rank(problem.bytes, owners, problem.ranks());
  return std::equal(used.begin(), used.end(), problem.memory.begin(), std::less_equal<>());
}

BalanceCosts costs_of(bool measured, std::int64_t every) {
  constexpr double seconds_per_counted = 1e-6;  // a body or a contact in an engine's step
  constexpr double least_horizon = 100;         // rounds: a gain lasts longer than to the next look
  BalanceCosts costs;
  costs.seconds_per_byte = 1e-9;
  costs.seconds_per_move = 2.5e-4;
  costs.seconds_per_load = measured ? 1.0 : seconds_per_counted;
  costs.rounds = std::max(least_horizon, static_cast<double>(every));
  return costs;
}

BalanceDecision decide(const BalanceProblem& problem, const Balancer& balancer, bool forced) {
  check(problem);
  BalanceDecision decision;
  decision.plan = balancer.plan(problem);
  check_owners(problem, decision.plan);
  decision.before = forecast(problem, problem.owner);
  decision.after = forecast(problem, decision.plan);
  count_moves(problem, decision);
  const BalanceCosts& costs = problem.costs;
  decision.gain_seconds = (decision.before.makespan - decision.after.makespan) * costs.seconds_per_load * costs.rounds;
  decision.worthwhile = decision.moves > 0 && (forced || pays(problem, decision));
  return decision;
}

}  // namespace moraine::runtime
