// SPDX-License-Identifier: Apache-2.0
// Within an epoch ranks hear from ranks that own neighbours, and from nobody else; how much does not depend on how many
// ranks there are elsewhere.
#include <gtest/gtest.h>

#include "tests/support/counting_transport.hpp"
#include "tests/support/gossip_model.hpp"
#include "tests/support/model_run.hpp"
#include "tests/support/rank_run.hpp"

namespace moraine {
namespace {

using runtime::Transport;
using runtime::test::CountingTransport;
using runtime::test::Sent;

/// What crossed from rank to rank, and from sub-model to sub-model on another rank.
struct Traffic {
  std::map<std::pair<int, int>, Sent> ranks;
  std::map<std::pair<SubModelId, SubModelId>, Sent> sub_models;
  std::int64_t collectives = 0;  ///< of rank 0
};

/// A beam of eight slabs, six diameters each: neighbours, which bounds closer than two diameters make, are those that
/// touch.
constexpr int slabs = 8;

Traffic beam(int ranks, std::int64_t& rounds) {
  const Scene scene =
      test::example("bonded_beam", {test::set("elements.0.cells", "[48, 3, 3]"), test::set("time.duration", 0.15),
                                    test::set("run.sub_models", slabs), test::set("run.split", "slabs")});
  Traffic traffic;
  std::mutex mutex;
  test::on_ranks({.ranks = ranks}, [&](Transport& inner) {
    CountingTransport transport(inner);
    CoupledModel model(scene, transport);
    runtime::Options options{.threads = 1, .transport = &transport};
    options.balance.balancer = "none";
    runtime::Simulation simulation(model, options);
    transport.start();
    simulation.run(0, scene.time.steps * scene.time.substeps);
    const std::lock_guard lock(mutex);
    for (const auto& [to, sent] : transport.to_ranks()) traffic.ranks[{inner.rank(), to}] = sent;
    for (const auto& [pair, sent] : transport.by_sub_models()) traffic.sub_models[pair] = sent;
    rounds = simulation.rounds() + static_cast<std::int64_t>(simulation.messages().epochs);
  });
  return traffic;
}

TEST(Neighbours, AreAllThatRanksTalkTo) {
  std::int64_t rounds = 0;
  for (const int ranks : {2, 4, 8}) {
    const Traffic traffic = beam(ranks, rounds);
    EXPECT_EQ(traffic.ranks.size(), 2U * (static_cast<std::size_t>(ranks) - 1));
    for (const auto& [pair, sent] : traffic.ranks) {
      EXPECT_EQ(std::abs(pair.first - pair.second), 1) << pair.first << " to " << pair.second << " of " << ranks;
      EXPECT_GT(sent.parcels, rounds / 2);
      EXPECT_LE(sent.parcels, rounds) << "one message per pair of neighbours and round, opening rounds included";
    }
  }
}

TEST(Neighbours, SayAsMuchHoweverManyRanksThereAreElsewhere) {
  std::int64_t rounds = 0;
  const Traffic many = beam(8, rounds);
  for (const int ranks : {2, 4}) {
    const Traffic few = beam(ranks, rounds);
    EXPECT_EQ(few.sub_models.size(), 2U * (static_cast<std::size_t>(ranks) - 1));
    for (const auto& [pair, sent] : few.sub_models) {
      EXPECT_EQ(sent, many.sub_models.at(pair)) << pair.first << " to " << pair.second;
      EXPECT_EQ(sent, few.ranks.at({static_cast<int>(pair.first) * ranks / slabs,
                                    static_cast<int>(pair.second) * ranks / slabs}));
    }
  }
}

/// A chain that talks for one epoch of so many rounds.
Traffic chain(int ranks, std::int64_t rounds) {
  Traffic traffic;
  std::mutex mutex;
  test::on_ranks({.ranks = ranks, .shuffled = true}, [&](Transport& inner) {
    CountingTransport transport(inner);
    runtime::test::GossipModel model(8, {{"say", runtime::Stage::none}, {"hear", 0}});
    for (SubModelId a = 0; a < 8; ++a) {
      if (a > 0) model.link(a, a - 1, 1);
      if (a < 7) model.link(a, a + 1, 1);
    }
    runtime::Simulation simulation(model, {.threads = 1, .transport = &transport});
    transport.start();
    simulation.run(0, rounds);
    const std::lock_guard lock(mutex);
    for (const auto& [to, sent] : transport.to_ranks()) traffic.ranks[{inner.rank(), to}] = sent;
    if (inner.rank() == 0) traffic.collectives = transport.collectives();
  });
  return traffic;
}

TEST(Epochs, HaveNoCollectiveInside) {
  const Traffic brief = chain(8, 10), lengthy = chain(8, 300);
  EXPECT_EQ(brief.collectives, lengthy.collectives);
  EXPECT_LE(brief.collectives, 2);
  EXPECT_EQ(lengthy.ranks.size(), 14U);
  for (const auto& [pair, sent] : lengthy.ranks) {
    EXPECT_EQ(std::abs(pair.first - pair.second), 1);
    EXPECT_EQ(sent.parcels, 301);
  }
}

}  // namespace
}  // namespace moraine
