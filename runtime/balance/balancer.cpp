// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/balancer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace moraine::runtime {
namespace {

void require(bool holds, std::string_view what) {
  if (!holds) throw std::invalid_argument(fmt::format("balance: {}", what));
}

bool is_amount(double value) { return std::isfinite(value) && value >= 0; }

bool are_amounts(const std::vector<double>& values) { return std::all_of(values.begin(), values.end(), is_amount); }

bool before(const Traffic& left, const Traffic& right) {
  return left.a != right.a ? left.a < right.a : left.b < right.b;
}

void check_traffic(const BalanceProblem& problem) {
  const Traffic* last = nullptr;
  for (const Traffic& traffic : problem.traffic) {
    require(traffic.a < traffic.b && traffic.b < problem.size() && is_amount(traffic.bytes), "traffic is malformed");
    require(last == nullptr || before(*last, traffic), "traffic is not ascending");
    last = &traffic;
  }
}

void check_costs(const BalanceCosts& costs) {
  for (const double value : {costs.seconds_per_byte, costs.seconds_per_move, costs.seconds_per_load, costs.rounds,
                             costs.least_imbalance_gain})
    require(is_amount(value), "a cost is negative or not finite");
}

}  // namespace

void check(const BalanceProblem& problem) {
  require(problem.ranks() > 0, "there are no ranks");
  require(problem.bytes.size() == problem.load.size(), "loads and bytes differ in number");
  require(problem.memory.empty() || problem.memory.size() == problem.speed.size(), "not every rank has a memory limit");
  require(are_amounts(problem.load) && are_amounts(problem.bytes) && are_amounts(problem.memory),
          "a load or size is negative or not finite");
  require(are_amounts(problem.speed) && std::count(problem.speed.begin(), problem.speed.end(), 0.0) == 0,
          "a speed is not positive");
  check_traffic(problem);
  check_costs(problem.costs);
  check_owners(problem, problem.owner);
}

void check_owners(const BalanceProblem& problem, const Owners& owners) {
  require(owners.size() == problem.load.size(), "owners and sub-models differ in number");
  for (const int rank : owners)
    require(rank >= 0 && rank < problem.ranks(), fmt::format("rank {} is not one of {}", rank, problem.ranks()));
}

}  // namespace moraine::runtime
