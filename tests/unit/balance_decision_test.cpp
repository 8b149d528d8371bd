// SPDX-License-Identifier: Apache-2.0
// When a plan is carried out.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/support/balance_problems.hpp"

namespace moraine::runtime {
namespace {

using namespace test;

BalanceDecision replayed(const BalanceProblem& problem, Owners owners, bool forced = false) {
  return decide(problem, *find_balancer("replay").make({{std::move(owners)}}), forced);
}

/// Six sub-models of 2 s, all but one on rank 0; the plan moves two.
BalanceProblem lopsided() {
  BalanceProblem problem = row({2, 2, 2, 2, 2, 2}, 2);
  problem.owner = {0, 0, 0, 0, 0, 1};
  problem.costs = {.seconds_per_byte = 1e-3, .seconds_per_move = 0.5, .rounds = 10};
  return problem;
}

TEST(Decision, ForecastsByHand) {
  const BalanceDecision decision = replayed(lopsided(), {0, 0, 0, 1, 1, 1});
  EXPECT_DOUBLE_EQ(decision.before.makespan, 10);
  EXPECT_DOUBLE_EQ(decision.before.imbalance, 10.0 / 6);
  EXPECT_DOUBLE_EQ(decision.after.makespan, 6);
  EXPECT_DOUBLE_EQ(decision.after.imbalance, 1);
  EXPECT_DOUBLE_EQ(decision.before.cut_bytes, 10);
  EXPECT_DOUBLE_EQ(decision.after.cut_bytes, 10);
  EXPECT_EQ(decision.moves, 2);
  EXPECT_DOUBLE_EQ(decision.bytes, 2000);
  EXPECT_DOUBLE_EQ(decision.gain_seconds, 40);
  EXPECT_DOUBLE_EQ(decision.cost_seconds, 2 * (0.5 + 1.0));
  EXPECT_TRUE(decision.worthwhile);
}

TEST(Decision, NeedsMoreGainThanCost) {
  BalanceProblem problem = lopsided();
  problem.costs.seconds_per_move = 18.9;  // 2 * (18.9 + 1) = 39.8 < 40
  EXPECT_TRUE(replayed(problem, {0, 0, 0, 1, 1, 1}).worthwhile);
  problem.costs.seconds_per_move = 19.1;
  EXPECT_FALSE(replayed(problem, {0, 0, 0, 1, 1, 1}).worthwhile);
  EXPECT_TRUE(replayed(problem, {0, 0, 0, 1, 1, 1}, true).worthwhile);
}

TEST(Decision, CountsWorkInItsOwnUnit) {
  BalanceProblem problem = lopsided();
  problem.costs.seconds_per_load = 1e-3;
  EXPECT_DOUBLE_EQ(replayed(problem, {0, 0, 0, 1, 1, 1}).gain_seconds, 0.04);
  EXPECT_FALSE(replayed(problem, {0, 0, 0, 1, 1, 1}).worthwhile);
}

/// Ranks send and receive at the same time: what counts is the busiest.
TEST(Decision, PaysForTheRankWithMostToMove) {
  BalanceProblem problem = row({1, 1, 1, 1}, 4);
  problem.costs = {.seconds_per_byte = 0, .seconds_per_move = 1};
  EXPECT_DOUBLE_EQ(replayed(problem, {1, 0, 3, 2}, true).cost_seconds, 2);
}

TEST(Decision, LeavesSmallGainsAlone) {
  BalanceProblem problem = row({1.0, 1.0, 1.015, 0.985}, 2);
  problem.load = {1.01, 1.01, 0.99, 0.99};  // 1 % above an even spread
  EXPECT_FALSE(replayed(problem, {0, 1, 0, 1}).worthwhile);
  problem.load = {1.03, 1.03, 0.97, 0.97};
  EXPECT_TRUE(replayed(problem, {0, 1, 0, 1}).worthwhile);
}

TEST(Decision, WantsSpeedCounted) {
  BalanceProblem problem = row({1, 1, 1, 1}, 2);
  problem.speed = {3, 1};
  EXPECT_DOUBLE_EQ(forecast(problem, problem.owner).makespan, 2);
  EXPECT_DOUBLE_EQ(forecast(problem, problem.owner).imbalance, 2);
  EXPECT_TRUE(replayed(problem, {0, 0, 0, 1}).worthwhile);
}

TEST(Decision, RefusesWhatMemoryDoesNotHold) {
  BalanceProblem problem = lopsided();
  problem.memory = {6000, 2000};
  EXPECT_FALSE(replayed(problem, {0, 0, 0, 1, 1, 1}).worthwhile);
  EXPECT_TRUE(replayed(problem, {0, 0, 0, 0, 1, 1}).worthwhile);
}

TEST(Decision, OfNoMovesIsNeverWorthwhile) {
  EXPECT_FALSE(replayed(lopsided(), lopsided().owner, true).worthwhile);
  EXPECT_EQ(replayed(lopsided(), lopsided().owner, true).moves, 0);
}

TEST(Decision, OfNoWorkIsBalanced) {
  const BalanceProblem problem = row({0, 0, 0}, 2);
  EXPECT_DOUBLE_EQ(forecast(problem, problem.owner).imbalance, 1);
}

TEST(Decision, RefusesPlansForOthers) {
  EXPECT_THROW(replayed(lopsided(), {0, 1}), std::invalid_argument);
  EXPECT_THROW(replayed(lopsided(), {0, 0, 0, 0, 0, 2}), std::invalid_argument);
  EXPECT_THROW(replayed(lopsided(), {0, 0, 0, 0, 0, -1}), std::invalid_argument);
}

TEST(Problem, IsCheckedWhole) {
  const auto expect_refused = [](auto&& spoil) {
    BalanceProblem problem = lopsided();
    ASSERT_NO_THROW(check(problem));
    spoil(problem);
    EXPECT_THROW(check(problem), std::invalid_argument);
  };
  expect_refused([](BalanceProblem& p) { p.load[2] = -1; });
  expect_refused([](BalanceProblem& p) { p.load[2] = std::numeric_limits<double>::quiet_NaN(); });
  expect_refused([](BalanceProblem& p) { p.bytes.pop_back(); });
  expect_refused([](BalanceProblem& p) { p.speed[1] = 0; });
  expect_refused([](BalanceProblem& p) { p.speed.clear(); });
  expect_refused([](BalanceProblem& p) { p.memory = {1}; });
  expect_refused([](BalanceProblem& p) { p.owner[0] = 2; });
  expect_refused([](BalanceProblem& p) { p.owner.push_back(0); });
  expect_refused([](BalanceProblem& p) { std::swap(p.traffic[0], p.traffic[1]); });
  expect_refused([](BalanceProblem& p) { p.traffic[1] = p.traffic[0]; });
  expect_refused([](BalanceProblem& p) { p.traffic.back() = {5, 6, 1.0}; });
  expect_refused([](BalanceProblem& p) { p.traffic.back() = {5, 5, 1.0}; });
  expect_refused([](BalanceProblem& p) { p.costs.rounds = -1; });
}

}  // namespace
}  // namespace moraine::runtime
