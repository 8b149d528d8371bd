// SPDX-License-Identifier: Apache-2.0
// An error on one rank ends all of them, with the same words.
#include <gtest/gtest.h>

#include <mutex>
#include <set>

#include "runtime/simulation.hpp"
#include "tests/support/gossip_model.hpp"
#include "tests/support/rank_run.hpp"

namespace moraine::runtime {
namespace {

using test::GossipModel;

TEST(Failure, EndsAllRanksWithOneMessage) {
  std::mutex mutex;
  std::multiset<std::string> said;
  moraine::test::on_ranks({.ranks = 4, .shuffled = true, .seed = 3}, [&](Transport& transport) {
    GossipModel model(8, {{"say", Stage::none}, {"hear", 0}});
    for (SubModelId a = 0; a < 8; ++a)
      for (SubModelId b = 0; b < 8; ++b)
        if (a != b && (a + 1 == b || b + 1 == a)) model.link(a, b, 1);
    model.sub_model(5).on_task = [](int stage, const Round& round) {
      if (stage == 1 && round.number == 12) throw std::runtime_error("no more");
    };
    Options options;
    options.threads = 1;
    options.transport = &transport;
    options.status_of = [](const std::exception_ptr&) { return 3; };
    try {
      Simulation(model, options).run(0, 100000);
    } catch (const RunError& e) {
      const std::lock_guard lock(mutex);
      said.insert(e.what());
      EXPECT_EQ(e.failure().status, 3);
    }
  });
  EXPECT_EQ(said.size(), 4U);
  EXPECT_EQ(said.count("rank 2, hear of sub-model 5 in round 12: no more"), 4U) << *said.begin();
}

/// One-way and mutual talk, to itself and others, between stages in any order.
TEST(Gossip, RemembersTheSameOnRanksWithOtherNeighboursInEveryEpoch) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    std::vector<std::uint64_t> alone;
    {
      test::RandomGossip model(seed, 9);
      Options options;
      options.threads = 1;
      Simulation(model, options).run(0, 60);
      alone = model.memories();
    }
    for (const int ranks : {2, 4}) {
      std::mutex mutex;
      moraine::test::on_ranks({.ranks = ranks, .shuffled = true, .seed = seed}, [&](Transport& transport) {
        test::RandomGossip model(seed, 9);
        Options options;
        options.threads = 2;
        options.transport = &transport;
        options.balance.balancer = "rotate";
        Simulation(model, options).run(0, 60);
        const std::lock_guard lock(mutex);
        for (SubModelId id = 0; id < 9; ++id) {
          if (!model.placement().holds(id)) continue;
          EXPECT_EQ(model.memories()[id], alone[id]) << seed << " on " << ranks;
        }
      });
    }
  }
}

}  // namespace
}  // namespace moraine::runtime
