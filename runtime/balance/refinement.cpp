// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/refinement.hpp"

#include <algorithm>
#include <numeric>

#include "runtime/balance/decision.hpp"
#include "runtime/balance/local_search.hpp"
#include "runtime/balance/longest_first.hpp"

namespace moraine::runtime {
namespace {

/// Owners take at least as long as an even spread, and as the largest sub-model on the fastest rank.
double least_makespan(const BalanceProblem& problem) {
  const double even = std::accumulate(problem.load.begin(), problem.load.end(), 0.0) /
                      std::accumulate(problem.speed.begin(), problem.speed.end(), 0.0);
  if (problem.load.empty()) return even;
  const double largest = *std::max_element(problem.load.begin(), problem.load.end());
  return std::max(even, largest / *std::max_element(problem.speed.begin(), problem.speed.end()));
}

}  // namespace

Owners refined(const BalanceProblem& problem, const Owners& start) {
  const Owners near = local_search(problem, start);
  const double makespan = forecast(problem, near).makespan;
  if (makespan <= 4.0 / 3.0 * least_makespan(problem)) return near;
  const Owners anew = longest_first(problem);
  return fits_memory(problem, anew) && forecast(problem, anew).makespan < makespan ? anew : near;
}

}  // namespace moraine::runtime
