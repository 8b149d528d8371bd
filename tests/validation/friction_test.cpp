// SPDX-License-Identifier: Apache-2.0
// Coulomb friction: a block and a sphere on an incline, a ball that begins to roll.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::floor_at_zero;
using test::impulse_engines;
using test::ModelRun;
using test::set;
using test::spheres;

constexpr double g = 9.81, slope = std::numbers::pi / 6;

/// Gravity turned instead of the floor: down the slope in direction `heading` [rad] in the plane.
Override on_slope(double heading) {
  return set("gravity", fmt::format("[{:.17g}, {:.17g}, {:.17g}]", g * std::sin(slope) * std::cos(heading),
                                    g * std::sin(slope) * std::sin(heading), -g * std::cos(slope)));
}

std::string block(double friction) {
  return "parameters: {dt: 1e-3}\nmaterials: {wood: {density: 250, friction: " + std::to_string(friction) +
         "}}\nelements:\n  - {packing: list, shape: {box: [0.2, 0.2, 0.1]}, mass: 1, items: [{id: 1, at: [0, 0, "
         "0.05]}]}\n"
         "time: {dt: dt, steps: 1}\n" +
         floor_at_zero;
}

/// Mean acceleration between 0.2 s and 0.7 s.
double acceleration(ModelRun& run, ElementId id) {
  run.steps(200);
  const double early = run.velocity(id).head<2>().norm();
  run.steps(500);
  return (run.velocity(id).head<2>().norm() - early) / 0.5;
}

/// Headings lie along, between and at 45 degrees to the two directions in which the engine keeps friction.
class Incline : public testing::TestWithParam<double> {
 protected:
  double heading() const { return GetParam() * std::numbers::pi / 180; }
};

TEST_P(Incline, BlockSlidesAsCoulombSays) {
  ModelRun run(scene_of(block(0.3), {on_slope(heading())}));
  const double a = acceleration(run, 1);
  EXPECT_NEAR(a, g * (std::sin(slope) - 0.3 * std::cos(slope)), 0.002 * 2.3563);
  RecordProperty("acceleration", fmt::format("{:.5f}", a));
  const Vec3 v = run.velocity(1);
  EXPECT_NEAR(std::atan2(v.y(), v.x()), heading(), 1e-3);
}

/// The slope's tangent, 0.57735, lies between.
TEST_P(Incline, BlockSticksAboveTheThresholdAndSlidesBelow) {
  double low = 0.4, high = 0.8;
  while (high - low > 0.001) {
    const double middle = (low + high) / 2;
    ModelRun run(scene_of(block(middle), {on_slope(heading())}));
    run.steps(1000);
    (run.velocity(1).norm() > 0.005 ? low : high) = middle;
  }
  RecordProperty("threshold", fmt::format("{:.5f}", (low + high) / 2));
  EXPECT_NEAR((low + high) / 2, std::tan(slope), 0.003 * std::tan(slope));
  ModelRun rest(scene_of(block(1.01 * std::tan(slope)), {on_slope(heading())}));
  rest.steps(500);
  const Vec3 from = rest.position(1);
  rest.steps(1000);
  RecordProperty("creep", fmt::format("{:.2e}", (rest.position(1) - from).norm()));
  EXPECT_LT((rest.position(1) - from).norm() / 1.0, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Heading, Incline, testing::Values(0.0, 30.0, 45.0),
                         [](const auto& test) { return fmt::format("{:.0f}deg", test.param); });

class SphereOnIncline : public testing::TestWithParam<std::tuple<double, std::string>> {
 protected:
  double heading() const { return std::get<0>(GetParam()) * std::numbers::pi / 180; }
  Override engine() const { return set("run.engine", std::get<1>(GetParam())); }
};

TEST_P(SphereOnIncline, RollsIfFrictionIsHigh) {
  for (const double mu : {0.17, 0.5}) {  // 0.16496 is enough
    ModelRun run(scene_of(spheres("{id: 1, at: [0, 0, 0.1]}", fmt::format("friction: {}", mu), floor_at_zero),
                          {on_slope(heading()), engine()}));
    const double a = acceleration(run, 1);
    RecordProperty(fmt::format("acceleration_{:.0f}", 100 * mu), fmt::format("{:.5f}", a));
    EXPECT_NEAR(a, 5.0 / 7 * g * std::sin(slope), 0.002 * 3.5036);
    EXPECT_NEAR(run.spin(1).norm() * 0.1, run.velocity(1).norm(), 0.002 * run.velocity(1).norm());
  }
}

TEST_P(SphereOnIncline, SlidesIfFrictionIsLow) {
  ModelRun run(
      scene_of(spheres("{id: 1, at: [0, 0, 0.1]}", "friction: 0.1", floor_at_zero), {on_slope(heading()), engine()}));
  const double a = acceleration(run, 1);
  const double spun = 0.1 * run.spin(1).norm() / run.time();
  RecordProperty("acceleration", fmt::format("{:.5f} {:.5f}", a, spun));
  EXPECT_NEAR(a, g * (std::sin(slope) - 0.1 * std::cos(slope)), 0.002 * 4.0554);
  EXPECT_NEAR(spun, 2.5 * 0.1 * g * std::cos(slope), 0.002 * 2.1239);
}

INSTANTIATE_TEST_SUITE_P(Heading, SphereOnIncline,
                         testing::Combine(testing::Values(0.0, 30.0, 45.0), testing::ValuesIn(impulse_engines)),
                         [](const auto& test) {
                           return fmt::format("{:.0f}deg_{}", std::get<0>(test.param), std::get<1>(test.param));
                         });

class SlidingToRolling : public testing::TestWithParam<std::tuple<double, std::string>> {};

TEST_P(SlidingToRolling, EndsWithFiveSevenths) {
  const auto& [mu, engine] = GetParam();
  ModelRun run(
      scene_of(spheres("{id: 1, at: [0, 0, 0.1], velocity: [1, 0, 0]}", fmt::format("friction: {}", mu), floor_at_zero),
               {set("run.engine", engine)}));
  const double expected_time = 2 / (7 * mu * g);
  while (run.time() < 2 * expected_time && run.velocity(1).x() - 0.1 * run.spin(1).y() > 1e-3) run.steps(1);
  EXPECT_NEAR(run.time(), expected_time, 1.5e-3);  // steps are 1e-3 long
  EXPECT_NEAR(run.position(1).x(), 12 / (49 * mu * g), 1.5e-3);
  run.steps(300);
  EXPECT_NEAR(run.velocity(1).x(), 5.0 / 7, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Friction, SlidingToRolling,
                         testing::Combine(testing::Values(0.1, 0.3, 0.5), testing::ValuesIn(impulse_engines)),
                         [](const auto& test) {
                           return fmt::format("mu{:.0f}_{}", 10 * std::get<0>(test.param), std::get<1>(test.param));
                         });

}  // namespace
}  // namespace moraine
