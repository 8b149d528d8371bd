// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "runtime/balance/relabel.hpp"
#include "tests/support/balance_problems.hpp"

namespace moraine::runtime {
namespace {

using namespace test;

double bytes_that_stay(const BalanceProblem& problem, const Owners& owners) {
  double bytes = 0;
  for (SubModelId s = 0; s < problem.size(); ++s)
    if (owners[s] == problem.owner[s]) bytes += problem.bytes[s];
  return bytes;
}

/// Tries all ways to give parts to ranks.
double most_that_can_stay(const BalanceProblem& problem, const Owners& plan) {
  std::vector<int> rank(problem.ranks());
  std::iota(rank.begin(), rank.end(), 0);
  double most = 0;
  do {
    Owners owners;
    for (const int part : plan) owners.push_back(rank[part]);
    most = std::max(most, bytes_that_stay(problem, owners));
  } while (std::next_permutation(rank.begin(), rank.end()));
  return most;
}

Owners random_owners(unsigned seed, const BalanceProblem& problem) {
  std::mt19937 random(seed);
  Owners owners;
  for (SubModelId s = 0; s < problem.size(); ++s) owners.push_back(static_cast<int>(random() % problem.ranks()));
  return owners;
}

TEST(Relabel, KeepsAtLeastHalfOfWhatCanStay) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    BalanceProblem problem = blocks(std::vector<double>(12, 1.0), 5);
    std::mt19937 random(seed);
    for (double& bytes : problem.bytes) bytes = 1.0 + random() % 100;
    const Owners plan = random_owners(seed, problem);
    EXPECT_GE(bytes_that_stay(problem, relabel(problem, plan)), most_that_can_stay(problem, plan) / 2) << seed;
  }
}

TEST(Relabel, FindsThePresentOwnersBehindOtherNames) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    BalanceProblem problem = blocks(std::vector<double>(20, 1.0), 6);
    problem.owner = random_owners(seed, problem);
    Owners renamed = problem.owner;
    for (int& rank : renamed) rank = (rank * 5 + 2) % 6;
    EXPECT_EQ(relabel(problem, renamed), problem.owner) << seed;
  }
}

TEST(Relabel, ExchangesRanksOfOneKindOnly) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const BalanceProblem problem = random_problem(seed);
    const Owners plan = random_owners(seed + 1000, problem);
    const Owners owners = relabel(problem, plan);
    for (SubModelId s = 0; s < problem.size(); ++s) {
      EXPECT_EQ(problem.speed[plan[s]], problem.speed[owners[s]]) << seed;
      for (SubModelId other = 0; other < s; ++other)
        EXPECT_EQ(plan[s] == plan[other], owners[s] == owners[other]) << seed;
    }
  }
}

}  // namespace
}  // namespace moraine::runtime
