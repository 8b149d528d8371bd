// SPDX-License-Identifier: Apache-2.0
// Ranks, threads, schedulers, balancers, the order in which messages come: none changes a bit.
#include <gtest/gtest.h>

#include "runtime/schedule/registry.hpp"
#include "tests/support/each_engine.hpp"
#include "tests/support/rank_run.hpp"

namespace moraine {
namespace {

using test::example;
using test::set;

struct Case {
  std::string name, scene;
  std::vector<Override> settings;
};

const std::vector<Case> examples = {
    {"crust_small",
     "crust_small",
     {set("count", 800), set("radius", "3000"), set("dt", 1), set("steps", 40), set("run.sub_models", 6)}},
    {"mixed_shapes", "mixed_shapes", {set("count", 80), set("time.duration", 1.2), set("run.sub_models", 5)}},
    {"resting_bed",
     "pushed_bed",
     {set("sections", 5), set("count", "40 * sections"), set("width", 2.5), set("settled", 3), set("time.duration", 4),
      set("run.skip_threshold", 0.1)}},
    {"bonded_beam", "bonded_beam", {set("time.duration", 0.3), set("run.sub_models", 5)}},
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

struct Outcome {
  std::uint64_t hash = 0;
  std::int64_t migrations = 0;
};

Outcome run(const Scene& scene, const runtime::LoopbackOptions& ranks, const runtime::Options& options) {
  Outcome outcome;
  test::on_ranks(ranks, [&](runtime::Transport& transport) {
    runtime::Options own = options;
    own.transport = &transport;
    CoupledModel model(scene, transport);
    runtime::Simulation simulation(model, own);
    simulation.run(0, scene.time.steps * scene.time.substeps);
    const std::vector<ElementState> states = model.states(0);
    if (transport.rank() == 0) outcome = {state_hash(scene, states), simulation.balance().migrations()};
  });
  return outcome;
}

runtime::Options options(const std::string& scheduler, int threads, const std::string& balancer) {
  runtime::Options o;
  o.scheduler = scheduler;
  o.threads = threads;
  o.balance.balancer = balancer;
  o.check_messages = true;
  return o;
}

class SameHash : public testing::TestWithParam<Case> {
 protected:
  const Scene scene_ = example(GetParam().scene, GetParam().settings);
  const std::uint64_t alone_ = run(scene_, {}, options("serial", 1, "none")).hash;
};

TEST_P(SameHash, OnAnyRanksAndThreads) {
  for (const int ranks : {2, 3, 4})
    for (const int threads : {1, 2})
      EXPECT_EQ(run(scene_, {.ranks = ranks}, options("hybrid", threads, "refine")).hash, alone_)
          << ranks << " x " << threads;
}

TEST_P(SameHash, WithEveryScheduler) {
  for (const runtime::SchedulerRow& row : runtime::schedulers())
    EXPECT_EQ(run(scene_, {.ranks = 2}, options(std::string(row.name), 2, "rotate")).hash, alone_) << row.name;
}

TEST_P(SameHash, WithEveryBalancerAndShuffledDelivery) {
  for (const runtime::BalancerRow& row : runtime::balancers())
    EXPECT_EQ(run(scene_, {.ranks = 3, .shuffled = true, .seed = 5}, options("hybrid", 1, std::string(row.name))).hash,
              alone_)
        << row.name;
}

TEST_P(SameHash, WhenEverySubModelMovesWheneverItCan) {
  const Outcome moved = run(scene_, {.ranks = 4, .shuffled = true, .seed = 2}, options("stealing", 1, "rotate"));
  EXPECT_EQ(moved.hash, alone_);
  EXPECT_GE(moved.migrations, scene_.run.sub_models);
}

TEST_P(SameHash, WithMoreRanksThanSubModels) {
  EXPECT_EQ(run(scene_, {.ranks = 9}, options("hybrid", 1, "greedy")).hash, alone_);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SameHash, testing::ValuesIn(test::with_every_engine(examples, 6)),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moraine
