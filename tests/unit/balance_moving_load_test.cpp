// SPDX-License-Identifier: Apache-2.0
// Balancers in the loop: predicted from what was, carried out where worthwhile, epoch after epoch.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/balance/initial_owners.hpp"
#include "runtime/balance/load_model.hpp"
#include "tests/support/balance_problems.hpp"

namespace moraine::runtime {
namespace {

using namespace test;

constexpr int ranks = 4;
constexpr SubModelId size = 8 * ranks;

/// A ridge of work, three times the rest, over a quarter of a row of sub-models.
std::vector<double> ridge(double at) {
  std::vector<double> load;
  for (SubModelId s = 0; s < size; ++s) load.push_back(std::abs(s + 0.5 - at) < size / 8.0 ? 3.0 : 1.0);
  return load;
}

struct Balanced {
  double imbalance;
  std::int64_t moves;
};

/// One epoch after the other: the load is met, remembered, and owners are settled for the next.
std::vector<Balanced> run(const std::string& balancer, const std::vector<std::vector<double>>& loads) {
  const BalancerRow& row_of_table = find_balancer(balancer);
  const auto policy = row_of_table.make({});
  BalanceProblem problem = row(std::vector<double>(size, 1.0), ranks);
  problem.owner = initial_owners(problem.load, problem.speed);
  problem.costs = {.seconds_per_byte = 1e-9, .seconds_per_move = 1e-3, .rounds = 10};
  std::vector<LoadHistory> history(size);
  std::vector<Balanced> epochs;
  for (const std::vector<double>& load : loads) {
    problem.load = load;
    epochs.push_back({imbalance(problem, problem.owner), 0});
    for (SubModelId s = 0; s < size; ++s) {
      history[s].add(load[s]);
      problem.load[s] = find_predictor("last").predict(history[s].loads());
    }
    const BalanceDecision decision = decide(problem, *policy, row_of_table.forced);
    if (decision.worthwhile) problem.owner = decision.plan;
    epochs.back().moves = decision.worthwhile ? decision.moves : 0;
    ++problem.turn;
  }
  return epochs;
}

/// Eight sub-models per rank have a mean load of 12 in all. Diffusion can only take what is at the border: where that
/// is of load 3, half of it may stay on the wrong side.
class MovingLoad : public testing::TestWithParam<const char*> {
 protected:
  const double even_ = GetParam() == std::string("diffusion") ? 1 + 1.5 / 12 : 1.08;
};

TEST_P(MovingLoad, IsEvenedOutInThreeRoundsThenLeftAlone) {
  const std::vector<Balanced> epochs = run(GetParam(), std::vector(20, ridge(size / 8.0)));
  EXPECT_GE(epochs[0].imbalance, 1.5);
  for (std::size_t i = 3; i < epochs.size(); ++i) {
    EXPECT_LE(epochs[i].imbalance, even_) << i;
    EXPECT_EQ(epochs[i].moves, 0) << i;
  }
}

/// The ridge jumps after ten epochs.
TEST_P(MovingLoad, IsEvenedOutAgainWhenItChanges) {
  std::vector<std::vector<double>> loads(10, ridge(size / 8.0));
  loads.insert(loads.end(), 10, ridge(size * 5 / 8.0));
  const std::vector<Balanced> epochs = run(GetParam(), loads);
  for (const std::size_t i : {3, 9, 13, 19}) EXPECT_LE(epochs[i].imbalance, even_) << i;
  for (const std::size_t i : {9, 19}) EXPECT_EQ(epochs[i].moves, 0) << i;
}

/// The ridge creeps on by half a sub-model each epoch: when it is met, one sub-model may have grown by 2 since.
TEST_P(MovingLoad, IsFollowed) {
  std::vector<std::vector<double>> loads;
  for (int epoch = 0; epoch < 20; ++epoch) loads.push_back(ridge(size / 8.0 + 0.5 * epoch));
  const std::vector<Balanced> epochs = run(GetParam(), loads);
  for (std::size_t i = 3; i < epochs.size(); ++i) EXPECT_LE(epochs[i].imbalance, even_ + 2.0 / 12) << i;
}

INSTANTIATE_TEST_SUITE_P(All, MovingLoad, testing::Values("greedy", "refine", "diffusion", "graph"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace moraine::runtime
