// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/balance/initial_owners.hpp"
#include "tests/support/balance_problems.hpp"

namespace moraine::runtime {
namespace {

using namespace test;

/// Tries all ways to cut `load` from `first` on into blocks for ranks from `rank` on.
double least_in_blocks(const BalanceProblem& problem, std::size_t first, int rank) {
  double own = 0;
  if (rank + 1 == problem.ranks()) {
    for (std::size_t s = first; s < problem.size(); ++s) own += problem.load[s];
    return own / problem.speed[rank];
  }
  double least = least_in_blocks(problem, first, rank + 1);
  for (std::size_t s = first; s < problem.size(); ++s) {
    own += problem.load[s];
    least = std::min(least, std::max(own / problem.speed[rank], least_in_blocks(problem, s + 1, rank + 1)));
  }
  return least;
}

TEST(InitialOwners, AreTheBestBlocksThereAre) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::vector<double> load(1 + random() % 9);
    for (double& l : load) l = random() % 50;
    load[0] += 1;
    BalanceProblem problem = blocks(load, 1 + static_cast<int>(random() % 4));
    if (seed % 2 == 1)
      for (double& speed : problem.speed) speed = 1.0 + random() % 4;
    const Owners owners = initial_owners(problem.load, problem.speed);
    check_owners(problem, owners);
    EXPECT_TRUE(std::is_sorted(owners.begin(), owners.end())) << seed;
    EXPECT_NEAR(makespan(problem, owners), least_in_blocks(problem, 0, 0), 1e-9) << seed;
  }
}

TEST(InitialOwners, SplitSevenEqualOnTwoRanks) {
  EXPECT_EQ(initial_owners(std::vector<double>(7, 3.0), std::vector<double>(2, 1.0)), (Owners{0, 0, 0, 0, 1, 1, 1}));
}

TEST(InitialOwners, LeaveNoRankWithoutWhereThereAreEnough) {
  for (int ranks = 1; ranks <= 9; ++ranks) {
    const Owners owners = initial_owners(std::vector<double>(9, 1.0), std::vector<double>(ranks, 1.0));
    for (int rank = 0; rank < ranks; ++rank) EXPECT_EQ(std::count(owners.begin(), owners.end(), rank) > 0, true);
  }
}

TEST(InitialOwners, OfFewerSubModelsThanRanksAreOneEach) {
  EXPECT_EQ(initial_owners(std::vector<double>{1, 2, 1}, std::vector<double>(5, 1.0)), (Owners{0, 1, 2}));
}

TEST(InitialOwners, TakeIdleSubModelsAsEqual) {
  EXPECT_EQ(initial_owners(std::vector<double>(4, 0.0), std::vector<double>(2, 1.0)), (Owners{0, 0, 1, 1}));
  EXPECT_TRUE(initial_owners({}, std::vector<double>(2, 1.0)).empty());
}

TEST(InitialOwners, GiveAFastRankMore) {
  EXPECT_EQ(initial_owners(std::vector<double>(8, 1.0), std::vector<double>{1, 3}), (Owners{0, 0, 1, 1, 1, 1, 1, 1}));
}

}  // namespace
}  // namespace moraine::runtime
