// SPDX-License-Identifier: Apache-2.0
// Sub-models at rest are skipped until something reaches them.
#include <gtest/gtest.h>

#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::ModelRun;
using test::set;

/// Balls on a floor. One rolls; the others lie apart from its way, and in its way, far off.
const std::string row = R"(
parameters: {skip: 0.01}
gravity: [0, 0, -9.81]
materials: {rock: {density: 1000, friction: 0.3, normal_stiffness: 2e7}}
elements:
  - packing: list
    shape: {sphere: 0.5}
    material: rock
    items:
      - {id: 1, at: [0, 0, 0.5], velocity: [8, 0, 0]}
      - {id: 2, at: [1, 5, 0.5]}
      - {id: 3, at: [2, 5, 0.5]}
      - {id: 4, at: [20, 0, 0.5]}
      - {id: 5, at: [21, 0, 0.5]}
      - {id: 6, at: [22, 0, 0.5]}
boundaries: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: rock}]
time: {dt: 1 / 120, steps: 1, substeps: 2}
run: {sub_models: 2, split: slabs, skip_threshold: skip}
)";

Scene row_for(const std::string& engine, double skip) {
  const std::string substeps = engine == "soft_sphere" ? "40" : "2";
  return scene_of(row, {set("run.engine", engine), set("skip", skip), set("time.substeps", substeps)});
}

class Rest : public testing::TestWithParam<std::string> {};

TEST_P(Rest, LastsUntilSomethingComes) {
  ModelRun run(row_for(GetParam(), 0.01));
  run.steps(120);
  EXPECT_FALSE(run.model().part(0).resting());
  EXPECT_TRUE(run.model().part(1).resting());
  EXPECT_EQ(run.of(6).twist.linear.norm(), run.model().part(1).state(2).twist.linear.norm());
  EXPECT_GT(run.model().statistics().rested_mean, 1);
  run.steps(420);
  EXPECT_GT(run.of(6).pose.position.x(), 22.5) << "the row was hit";

  ModelRun awake(row_for(GetParam(), 0));
  awake.steps(540);
  EXPECT_EQ(awake.model().statistics().rested_mean, 0);
  EXPECT_NEAR(run.of(6).pose.position.x(), awake.of(6).pose.position.x(), 0.1);
  EXPECT_NEAR(run.of(1).pose.position.x(), awake.of(1).pose.position.x(), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Engines, Rest, testing::Values("bullet", "impulse", "soft_sphere", "ode"),
                         [](const auto& engine) { return engine.param; });

TEST(RestingBed, IsPushedAtOneEndOnly) {
  const auto bed = [](double skip) {
    return test::example("pushed_bed", {set("sections", 4), set("time.duration", 8), set("run.skip_threshold", skip)});
  };
  ModelRun skipped(bed(0.05)), whole(bed(0));
  skipped.go();
  whole.go();
  const ModelStatistics with = skipped.model().statistics(), without = whole.model().statistics();
  const double elements = static_cast<double>(skipped.scene().elements.size());
  EXPECT_FALSE(skipped.model().part(0).resting()) << "the wall is there";
  EXPECT_GT(with.rested_mean, 0.03 * elements);
  EXPECT_EQ(without.rested_mean, 0);
  EXPECT_LT(with.linear_residual, 1e-3);
  EXPECT_LT((with.ledger.mass_moment - without.ledger.mass_moment).norm() / with.ledger.mass, 0.02) << "[m]";
}

TEST(RestLimits, ScaleWithTheScene) {
  WorldSettings world;
  world.length_unit = 4;
  world.time_unit = 2;
  world.substep = 0.01;
  const RestLimits limits = rest_limits(world, 0.01);
  EXPECT_DOUBLE_EQ(limits.speed, 0.02);
  EXPECT_DOUBLE_EQ(limits.shift, 0.004);
  EXPECT_EQ(limits.rounds, 20);
  EXPECT_FALSE(rest_limits(world, 0).on());
}

}  // namespace
}  // namespace moraine
