// SPDX-License-Identifier: Apache-2.0
// What every balancer in the table must do.
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

#include "tests/support/balance_problems.hpp"

namespace moraine::runtime {
namespace {

using namespace test;

std::vector<std::string> balancer_names() {
  std::vector<std::string> names;
  for (const BalancerRow& row : balancers()) names.emplace_back(row.name);
  return names;
}

class Balancing : public testing::TestWithParam<std::string> {
 protected:
  const BalancerRow& row_ = find_balancer(GetParam());

  /// For a balancer that is told its plans: everything to the last rank.
  Owners planned(const BalanceProblem& problem) const {
    return row_.make({{Owners(problem.size(), problem.ranks() - 1)}})->plan(problem);
  }
};

TEST_P(Balancing, GivesEverySubModelARank) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    const BalanceProblem problem = random_problem(seed);
    ASSERT_NO_THROW(check(problem)) << seed;
    EXPECT_NO_THROW(check_owners(problem, planned(problem))) << seed;
  }
}

TEST_P(Balancing, PlansTheSameAgain) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Owners first = planned(random_problem(seed));
    planned(random_problem(seed + 1));
    EXPECT_EQ(planned(random_problem(seed)), first) << seed;
  }
}

TEST_P(Balancing, NeverCarriesOutWhatMakesThingsWorseUnlessForced) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    const BalanceProblem problem = random_problem(seed);
    const BalanceDecision decision = decide(problem, *row_.make({}), row_.forced);
    if (!decision.worthwhile || row_.forced) continue;
    EXPECT_LT(decision.after.makespan, decision.before.makespan) << seed;
    EXPECT_TRUE(fits_memory(problem, decision.plan)) << seed;
  }
}

TEST_P(Balancing, LeavesABalancedSceneAlone) {
  for (const int ranks : {1, 2, 4, 16}) {
    const BalanceProblem problem = grid(8, 8, ranks);
    EXPECT_FALSE(decide(problem, *row_.make({}), false).worthwhile) << ranks;
  }
}

TEST_P(Balancing, KeepsAllOnTheOnlyRank) {
  const BalanceProblem problem = grid(3, 2, 1);
  EXPECT_EQ(planned(problem), Owners(6, 0));
  EXPECT_FALSE(decide(problem, *row_.make({}), row_.forced).worthwhile);
}

TEST_P(Balancing, TakesMoreRanksThanSubModelsAndNothingAtAll) {
  EXPECT_NO_THROW(check_owners(row({1, 2, 3}, 50), planned(row({1, 2, 3}, 50))));
  EXPECT_TRUE(planned(blocks({}, 3)).empty());
  const BalanceProblem idle = row({0, 0, 0, 0}, 2);
  EXPECT_NO_THROW(check_owners(idle, planned(idle)));
}

INSTANTIATE_TEST_SUITE_P(All, Balancing, testing::ValuesIn(balancer_names()),
                         [](const auto& test) { return test.param; });

TEST(BalancerTable, HasUniqueNamesWithHelp) {
  std::set<std::string_view> names;
  for (const BalancerRow& row : balancers()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_FALSE(row.help.empty());
    EXPECT_EQ(row.help.find('\n'), std::string_view::npos);
    EXPECT_EQ(find_balancer(row.name).make, row.make);
  }
}

TEST(BalancerTable, ListsItselfIfAskedForAnother) {
  try {
    find_balancer("fairest");
    FAIL();
  } catch (const std::invalid_argument& error) {
    for (const BalancerRow& row : balancers())
      EXPECT_NE(std::string(error.what()).find(row.name), std::string::npos) << row.name;
  }
}

}  // namespace
}  // namespace moraine::runtime
