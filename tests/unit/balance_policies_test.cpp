// SPDX-License-Identifier: Apache-2.0
// Each balancer against what is known to be best.
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "tests/support/balance_problems.hpp"

namespace moraine::runtime {
namespace {

using namespace test;

std::vector<double> random_loads(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::vector<double> loads;
  for (std::size_t i = 0; i < count; ++i) loads.push_back(1.0 + random() % 100);
  return loads;
}

TEST(Greedy, KeepsGrahamsBound) {
  for (unsigned seed = 0; seed < 60; ++seed)
    for (const int ranks : {2, 3}) {
      const BalanceProblem problem = blocks(random_loads(seed, 1 + seed % 8), ranks);
      EXPECT_LE(makespan(problem, plan("greedy", problem)),
                (4.0 / 3 - 1.0 / (3 * ranks)) * least_makespan(problem) * (1 + 1e-12))
          << seed;
    }
}

/// Graham's own worst case for three ranks: the bound is reached.
TEST(Greedy, IsAsBadAsGrahamSays) {
  const BalanceProblem problem = blocks({5, 5, 4, 4, 3, 3, 3}, 3);
  EXPECT_DOUBLE_EQ(least_makespan(problem), 9);
  EXPECT_DOUBLE_EQ(makespan(problem, plan("greedy", problem)), 11);
}

TEST(Refine, IsWithinFourThirdsOfTheBestFromAnywhere) {
  for (unsigned seed = 0; seed < 60; ++seed)
    for (const int ranks : {2, 3}) {
      BalanceProblem problem = blocks(random_loads(seed, 1 + seed % 8), ranks);
      problem.owner.assign(problem.size(), static_cast<int>(seed % ranks));
      EXPECT_LE(makespan(problem, plan("refine", problem)), 4.0 / 3 * least_makespan(problem) * (1 + 1e-12)) << seed;
    }
}

TEST(Refine, NeverRaisesTheMakespanOrLeavesMemory) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    const BalanceProblem problem = random_problem(seed);
    const Owners owners = plan("refine", problem);
    EXPECT_LE(makespan(problem, owners), makespan(problem, problem.owner)) << seed;
    EXPECT_TRUE(fits_memory(problem, owners) || !fits_memory(problem, problem.owner)) << seed;
  }
}

class LoadBalancers : public testing::TestWithParam<const char*> {};

TEST_P(LoadBalancers, SplitSevenEqualOnTwoRanksIntoFourAndThree) {
  BalanceProblem problem = row({1, 1, 1, 1, 1, 1, 1}, 2);
  problem.owner = {0, 0, 0, 0, 0, 0, 1};
  EXPECT_DOUBLE_EQ(makespan(problem, plan(GetParam(), problem)), 4);
}

/// 10 is the best; 12 if blocks must stay in one piece, as diffusion keeps them.
TEST_P(LoadBalancers, MakeRoomForACostlySubModel) {
  const BalanceProblem problem = row({1, 1, 10, 1, 1, 1, 1, 1, 1, 1, 1}, 2);
  EXPECT_DOUBLE_EQ(least_makespan(problem), 10);
  const double expected = GetParam() == std::string("diffusion") ? 12 : 10;
  EXPECT_DOUBLE_EQ(makespan(problem, plan(GetParam(), problem)), expected);
}

/// The best is 6 on the fast rank and 2 on each slow one.
TEST_P(LoadBalancers, GiveAFastRankMore) {
  BalanceProblem problem = row(std::vector<double>(10, 1.0), 3);
  problem.speed = {3, 1, 1};
  EXPECT_DOUBLE_EQ(least_makespan(problem), 2);
  EXPECT_DOUBLE_EQ(makespan(problem, plan(GetParam(), problem)), 2);
}

INSTANTIATE_TEST_SUITE_P(All, LoadBalancers, testing::Values("greedy", "refine", "diffusion", "graph"),
                         [](const auto& test) { return std::string(test.param); });

/// Which rank has which number does not matter where speeds are equal. Refine may end elsewhere, but as well: it starts
/// from one of several slowest ranks, and ends within 2 % of even.
TEST(Balancers, DoNotCareForTheNamesOfRanks) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const BalanceProblem problem = row(random_loads(seed, 24), 4);
    BalanceProblem renamed = problem;
    for (int& rank : renamed.owner) rank = (rank * 3 + 1) % 4;
    const auto imbalances = [&](const char* name) {
      return std::pair(imbalance(problem, plan(name, problem)), imbalance(renamed, plan(name, renamed)));
    };
    for (const char* name : {"greedy", "diffusion"}) EXPECT_EQ(imbalances(name).first, imbalances(name).second) << seed;
    EXPECT_NEAR(imbalances("refine").first, imbalances("refine").second, 0.02) << seed;
  }
}

TEST(Greedy, LeavesWhatIsEvenWhereItIs) {
  const BalanceProblem problem = row({4, 1, 3, 2, 2, 3, 1, 4}, 4);
  EXPECT_EQ(plan("greedy", problem), problem.owner);
}

TEST(Refine, MovesOnlyWhatItMust) {
  BalanceProblem problem = row({1, 1, 1, 1, 1, 1, 1, 1}, 4);
  problem.owner = {0, 0, 1, 1, 2, 2, 2, 3};
  const Owners owners = plan("refine", problem);
  EXPECT_EQ(owners, (Owners{0, 0, 1, 1, 2, 2, 3, 3}));
}

TEST(Refine, SwapsWhereNoMoveHelps) {
  const BalanceProblem problem = blocks({5, 5, 3, 3}, 2);
  EXPECT_DOUBLE_EQ(makespan(problem, plan("refine", problem)), 8);
  EXPECT_EQ(moves(problem.owner, plan("refine", problem)), 2);
}

/// A swap of the two at the border would cut three links, others cut two.
TEST(Refine, SwapsWhatCutsFewestMessages) {
  const BalanceProblem problem = row({5, 5, 3, 3}, 2);
  EXPECT_DOUBLE_EQ(forecast(problem, plan("refine", problem)).cut_bytes, 20);
}

/// No move or swap helps here, though the best is 4.
TEST(Refine, StartsAnewWhereItIsStuck) {
  BalanceProblem problem = blocks({3, 3, 1, 1, 1, 3, 1, 3}, 4);
  problem.owner = {3, 2, 1, 1, 1, 1, 1, 3};
  EXPECT_DOUBLE_EQ(makespan(problem, plan("refine", problem)), 4);
}

std::set<std::pair<int, int>> neighbouring_ranks(const BalanceProblem& problem) {
  std::set<std::pair<int, int>> pairs;
  for (const Traffic& traffic : problem.traffic) {
    const int a = problem.owner[traffic.a], b = problem.owner[traffic.b];
    pairs.insert({a, b});
    pairs.insert({b, a});
  }
  return pairs;
}

TEST(Diffusion, MovesBetweenNeighboursOnlyAndNeverRaisesTheMakespan) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    const BalanceProblem problem = random_problem(seed);
    const auto neighbours = neighbouring_ranks(problem);
    const Owners owners = plan("diffusion", problem);
    for (SubModelId s = 0; s < problem.size(); ++s) {
      const std::pair move(problem.owner[s], owners[s]);
      EXPECT_TRUE(move.first == move.second || neighbours.contains(move)) << seed;
    }
    EXPECT_LE(makespan(problem, owners), makespan(problem, problem.owner)) << seed;
  }
}

/// A row of ranks, all work on the first: what is at its end goes on, in order.
TEST(Diffusion, KeepsARowInOrder) {
  BalanceProblem problem = row(std::vector<double>(32, 1.0), 4);
  problem.owner.assign(32, 0);
  problem.owner[29] = 1;
  problem.owner[30] = 2;
  problem.owner[31] = 3;
  for (int turn = 0; turn < 12; ++turn) problem.owner = plan("diffusion", problem);
  EXPECT_TRUE(std::is_sorted(problem.owner.begin(), problem.owner.end()));
  EXPECT_LE(imbalance(problem, problem.owner), 1.13);  // at most one sub-model too many
}

/// A square on four ranks: quarters cut 16 links, the fewest an even split can.
TEST(Graph, KeepsNeighboursTogether) {
  BalanceProblem problem = grid(8, 8, 4);
  for (SubModelId s = 0; s < 64; ++s) problem.owner[s] = static_cast<int>(s % 4);
  problem.costs.rounds = 1e6;
  const Forecast after = forecast(problem, plan("graph", problem));
  EXPECT_LE(after.imbalance, 1.0 + 1.0 / 16 + 1e-12);
  EXPECT_LE(after.cut_bytes, 10 * 24);  // owners in stripes
}

TEST(Graph, MovesLittleIfMovesCostMoreThanMessages) {
  BalanceProblem problem = grid(8, 8, 4);
  for (SubModelId s = 0; s < 16; ++s) problem.load[s] = 2;
  const auto moved_with = [&](double bytes) {
    problem.bytes.assign(64, bytes);
    return moves(problem.owner, plan("graph", problem));
  };
  EXPECT_LE(moved_with(1e6), moved_with(1.0));
  EXPECT_LE(moved_with(1e6), 24);
}

TEST(Graph, HoldsItsBoundOnTheImbalance) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    BalanceProblem problem = grid(8, 8, 8);
    problem.load = random_loads(seed, 64);
    EXPECT_LE(imbalance(problem, plan("graph", problem)), 1.08) << seed;
  }
}

/// A quarter of the square costs three times as much as the rest.
BalanceProblem ridge(SubModelId side, int ranks) {
  BalanceProblem problem = grid(side, side, ranks);
  for (SubModelId s = 0; s < problem.size(); ++s) problem.load[s] = s % side < side / 4 ? 3 : 1;
  return problem;
}

TEST(Graph, LeavesHalfInPlace) {
  BalanceProblem problem = ridge(16, 32);
  problem.costs.rounds = 20;
  EXPECT_LE(moves(problem.owner, plan("graph", problem)), 128);
}

TEST(Graph, KeepsToMemory) {
  for (const double limit : {8000.0, 9000.0, 12000.0}) {
    BalanceProblem problem = ridge(16, 32);
    problem.memory.assign(32, limit);
    EXPECT_TRUE(fits_memory(problem, plan("graph", problem))) << limit;
  }
}

TEST(Rotate, MovesAllToTheNextRank) {
  EXPECT_EQ(plan("rotate", row({1, 1, 1, 1}, 3)), (Owners{1, 1, 2, 0}));
  EXPECT_TRUE(find_balancer("rotate").forced);
}

TEST(Replay, GivesItsPlansByTurnThenKeeps) {
  const auto replay = find_balancer("replay").make({{{1, 1}, {0, 1}}});
  BalanceProblem problem = row({1, 1}, 2);
  EXPECT_EQ(replay->plan(problem), (Owners{1, 1}));
  problem.turn = 1;
  EXPECT_EQ(replay->plan(problem), (Owners{0, 1}));
  problem.turn = 2;
  problem.owner = {1, 0};
  EXPECT_EQ(replay->plan(problem), (Owners{1, 0}));
}

}  // namespace
}  // namespace moraine::runtime
