// SPDX-License-Identifier: Apache-2.0
// Accounts of energy and force, and the guards that look at them.
#include <gtest/gtest.h>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"
#include "tests/support/rank_run.hpp"

namespace moraine {
namespace {

using test::floor_at_zero;
using test::ModelRun;
using test::set;
using test::spheres;
using test::weightless;

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](auto& t) { return t.find(part) != std::string::npos; });
}

struct EngineStep {
  const char* engine;
  double dt;
};
const EngineStep engine_steps[] = {{"bullet", 1e-3}, {"impulse", 1e-3}, {"soft_sphere", 2e-5}};

std::vector<Override> with(const EngineStep& e, double seconds) {
  return {set("run.engine", e.engine), set("dt", e.dt), set("time.steps", std::ceil(seconds / e.dt))};
}

/// An elastic ball that a plate of speed 1 m/s drives off leaves at 2 m/s: the plate worked m 1 * 2.
TEST(EnergyAccount, PlatesWork) {
  const std::string scene = spheres("{id: 1, at: [0.2, 0, 0]}", "restitution: 1",
                                    weightless +
                                        "boundaries: [{plate: {size: [0.2, 2, 2], at: [-0.1, 0, 0]}, kinematic: true, "
                                        "motion: {velocity: [1, 0, 0]}}]\n");
  for (const EngineStep& e : engine_steps) {
    ModelRun run(scene_of(scene, with(e, 0.2)));
    const EnergyAccount a = run.go().model().statistics().energy;
    EXPECT_NEAR(run.velocity(1).x(), 2, 0.01) << e.engine;
    EXPECT_NEAR(a.work_of_boundaries, 2, 0.02) << e.engine;
    EXPECT_NEAR(a.dissipated, 0, 0.02) << e.engine;
  }
}

TEST(EnergyAccount, ImpactsDissipate) {
  const std::string scene = spheres("{id: 1, at: [-0.11, 0, 0], velocity: [1, 0, 0]}, {id: 2, at: [0.11, 0, 0]}",
                                    "restitution: 0.5", weightless);
  for (const EngineStep& e : engine_steps) {
    ModelRun run(scene_of(scene, with(e, 0.1)));
    run.go().conclude();
    const EnergyAccount a = run.model().statistics().energy;
    EXPECT_NEAR(a.dissipated, 0.25 * (1 - 0.25), 0.003) << e.engine << ": (1 - e^2) / 4 m v^2";
    EXPECT_LT(a.gained, 1e-3) << e.engine;
    EXPECT_TRUE(run.model().warnings().empty()) << run.model().warnings().front();
  }
}

/// Energy goes from motion to contacts and bonds and back, cut or not.
TEST(EnergyAccount, SpringsHoldWhatMotionLost) {
  const std::string scene =
      spheres("{id: 1, at: [-0.11, 0, 0], velocity: [1, 0, 0]}, {id: 2, at: [0.11, 0, 0]}, {id: 3, at: [0.4, 0, 0]}",
              "restitution: 1", weightless + "bonds: [{a: 2, b: 3, stiffness: 2000}]\n");
  for (const char* parts : {"1", "2", "3"}) {
    double bond = 0, contact = 0;
    ModelRun run(scene_of(scene, {set("run.engine", "soft_sphere"), set("dt", 2e-5), set("run.sub_models", parts),
                                  set("run.split", "slabs"), set("materials.ball.normal_stiffness", 1e5)}));
    for (int k = 0; k < 60; ++k) {
      run.steps(100);
      const EnergyAccount a = run.model().statistics().energy;
      EXPECT_NEAR(a.kinetic + a.bond + a.contact, 0.5, 2e-3) << parts << " at " << run.time();
      bond = std::max(bond, a.bond);
      contact = std::max(contact, a.contact);
    }
    EXPECT_GT(bond, 0.1) << parts;
    EXPECT_GT(contact, 0.2) << parts;
  }
}

TEST(BoundaryForce, IsTheWeightOfWhatRests) {
  const std::string scene =
      spheres("{id: 1, at: [0, 0, 0.1]}, {id: 2, at: [0, 0, 0.3]}", "restitution: 0", floor_at_zero);
  for (const EngineStep& e : engine_steps) {
    ModelRun run(scene_of(scene, with(e, 1)));
    run.go();
    const auto rounds = run.scene().time.steps;
    EXPECT_NEAR(run.model().statistics(rounds).boundary_force.z(), 2 * 9.81, 1e-3 * 2 * 9.81) << e.engine;
  }
}

/// What landed before the last fifth of the run does not count, however long epochs are.
TEST(BoundaryForce, IsAMeanOverTheLastFifth) {
  const std::string scene = spheres("{id: 1, at: [0, 0, 0.12], velocity: [0, 0, -1]}", "restitution: 0", floor_at_zero);
  for (const EngineStep& e : engine_steps) {
    ModelRun run(scene_of(scene, with(e, 0.06)));
    run.go();
    EXPECT_NEAR(run.model().statistics(run.scene().time.steps).boundary_force.z(), 9.81, 1e-2 * 9.81) << e.engine;
  }
}

TEST(BoundaryForce, IsKnownAfterOneStep) {
  const std::string scene = spheres("{id: 1, at: [0, 0, 0.1]}", "restitution: 0", floor_at_zero);
  ModelRun run(scene_of(scene, {set("run.engine", "impulse"), set("time.steps", 1)}));
  run.go().conclude();
  EXPECT_GT(run.model().statistics(1).boundary_force.z(), 1);
}

const std::string box = "boundaries: [{box: [[-1, -1, -1], [1, 1, 1]], triangulated: true}]\n";

TEST(Guards, WarnOfTunnellingBeforeItHappens) {
  const std::string scene = spheres("{id: 4, at: [0, 0, 0], velocity: [10, 0, 0]}", "restitution: 1", weightless + box);
  ModelRun run(scene_of(scene, {set("dt", 6e-3)}));
  run.steps(1);
  const std::vector<std::string> texts = run.model().warnings();
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_TRUE(mentions(texts, "tunnelling: element 4 goes 0.6 of its radius")) << texts[0];
  EXPECT_TRUE(mentions(texts, "at least 2 substeps")) << texts[0];
}

/// What falls far for its size does not run away: there is a floor down there.
TEST(Guards, LetASmallBallFallFar) {
  const std::string scene = spheres("{id: 1, at: [0, 0, 50]}", "restitution: 0", floor_at_zero);
  ModelRun run(scene_of(scene, {set("time.steps", 3500)}));
  EXPECT_NO_THROW(run.go());
  EXPECT_NEAR(run.position(1).z(), 0.1, 0.01);
}

/// In a step it goes from 0.17 m before the wall to 0.17 m behind it: engines do not look that far ahead.
TEST(Guards, StopWhenAnElementHasLeftItsContainer) {
  const std::string scene =
      spheres("{id: 4, at: [0.19, 0, 0], velocity: [90, 0, 0]}", "restitution: 1", weightless + box);
  for (const char* engine : {"bullet", "impulse"}) {
    ModelRun run(scene_of(scene, {set("dt", 6e-3), set("run.engine", engine)}));
    try {
      run.steps(64);
      ADD_FAILURE() << engine << ": it is at " << run.position(4).x() << " m";
    } catch (const InvalidStateError& e) {
      EXPECT_NE(std::string(e.what()).find("escape: element 4"), std::string::npos) << e.what();
    }
  }
}

TEST(Guards, TellWhatFallsForEver) {
  const std::string scene = spheres("{id: 1, at: [0, 0, 0.1]}, {id: 2, at: [2, 0, 0.1]}", "restitution: 0",
                                    "boundaries: [{plate: {size: [1, 1, 0.2], at: [0, 0, -0.1]}}]\n");
  ModelRun run(scene_of(scene, {set("time.steps", 700)}));
  run.go().conclude();
  EXPECT_TRUE(mentions(run.model().warnings(), "falling: element 2 is below all boundaries"));
}

TEST(Guards, KeepQuietWhereNothingIsWrong) {
  for (const char* name : {"dam", "heap", "box_settle", "bonded_beam"}) {
    ModelRun run(test::example(name, {set("time.duration", 0.5), set("run.sub_models", 3)}));
    run.go().conclude();
    EXPECT_TRUE(run.model().warnings().empty()) << name << ": " << run.model().warnings().front();
  }
}

TEST(Guards, WarnOfStepsTooLongForTheWeight) {
  ModelRun run(test::example("box_settle", {set("time.dt", 0.05), set("time.substeps", 1)}));
  run.steps(1);
  EXPECT_TRUE(mentions(run.model().warnings(), "substep: a substep of 0.05 s")) << "of sqrt(d / g)";
}

TEST(Guards, SayTheSameOnEveryRank) {
  const Scene scene = test::example("dam", {set("count", 300), set("time.steps", 40), set("time.dt", 0.04),
                                            set("time.substeps", 1), set("run.sub_models", 4)});
  ModelRun alone(scene);
  alone.go().conclude();
  ASSERT_FALSE(alone.model().warnings().empty());
  test::on_ranks({.ranks = 3}, [&](runtime::Transport& transport) {
    CoupledModel model(scene, transport);
    runtime::Options options;
    options.transport = &transport;
    runtime::Simulation(model, options).run(0, 40);
    model.conclude(40);
    EXPECT_EQ(model.warnings(), alone.model().warnings()) << transport.rank();
  });
}

/// Where `coupling: mirror` loses momentum, somebody must say so.
TEST(Guards, NoticeLostMomentum) {
  ModelRun run(test::example(
      "dam", {set("count", 300), set("time.duration", 1), set("run.sub_models", 4), set("run.coupling", "mirror")}));
  run.go().conclude();
  EXPECT_TRUE(mentions(run.model().warnings(), "momentum: "));
}

/// The table itself, with numbers made up.
TEST(GuardLog, WarnsOnceCountsAndStops) {
  const Scene scene = scene_of(spheres("{id: 7, at: [0, 0, 0]}", "restitution: 0", ""));
  ModelContext context;
  context.scene = &scene;
  context.engine = &find_engine("bullet");
  context.speed_limit = 10;
  Accounts accounts;
  Watch watch{context, {}, accounts, 0, 0, 0, 0};
  GuardLog log;
  log.look(watch, 0);
  EXPECT_TRUE(log.warnings(context).empty());
  watch.extremes.stride = {0.7, 7};
  log.look(watch, 1);
  watch.extremes.stride = {0.9, 7};
  log.look(watch, 2);
  EXPECT_EQ(log.take_news().size(), 1U);
  EXPECT_EQ(log.take_news().size(), 0U);
  EXPECT_TRUE(mentions(log.warnings(context), "(in 2 of 3 looks, at worst 0.9 at step 2)"));
  watch.extremes.beyond = {1.5, 7};
  EXPECT_THROW(log.look(watch, 3), InvalidStateError);
  watch.extremes.beyond = {};
  accounts.kinetic_max = 1;
  accounts.gained = 0.17;
  EXPECT_NO_THROW(log.look(watch, 4)) << "a sixth of all energy";
  EXPECT_TRUE(mentions(log.warnings(context), "energy: "));
  accounts.gained = 0.5;
  EXPECT_THROW(log.look(watch, 4), InvalidStateError) << "half of all energy came from nowhere";
}

}  // namespace
}  // namespace moraine
