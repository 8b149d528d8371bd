// SPDX-License-Identifier: Apache-2.0
// One body: free flight, and a ball that bounces.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::floor_at_zero;
using test::in_two;
using test::ModelRun;
using test::set;
using test::spheres;

/// Symplectic Euler falls short of the parabola by g t dt / 2 exactly, and by nothing else.
TEST(Projectile, HasTheErrorOfTheTimeStepAndNoOther) {
  for (const double dt : {1.0 / 60, 1.0 / 240, 1e-3}) {
    ModelRun run(
        scene_of(spheres("{id: 1, at: [0, 0, 100], velocity: [3, 0, 4]}", "friction: 0", ""), {set("dt", dt)}));
    run.steps(std::lround(1 / dt));
    const double error = run.position(1).z() - (100 + 4 - 0.5 * 9.81);
    EXPECT_NEAR(error, -0.5 * 9.81 * dt, 0.01 * 0.5 * 9.81 * dt) << dt;
    EXPECT_NEAR(run.position(1).x(), 3, 5e-5) << dt;
    EXPECT_NEAR(run.velocity(1).z(), 4 - 9.81, 5e-5) << dt;
    EXPECT_NEAR(run.velocity(1).x(), 3, 1e-6) << dt;
  }
}

/// Two bodies that share a cut but do not touch fly as if alone, with ghosts or without.
TEST(Projectile, FliesTheSameBesideAnother) {
  ModelRun alone(scene_of(spheres("{id: 1, at: [0, 0, 100], velocity: [3, 0, 4]}", "friction: 0", "")));
  ModelRun beside(
      scene_of(spheres("{id: 1, at: [0, 0, 100], velocity: [3, 0, 4]}, "
                       "{id: 2, at: [0, 0.205, 100], velocity: [3, 0, 4]}",
                       "friction: 0", in_two)));
  alone.steps(1000);
  beside.steps(1000);
  EXPECT_EQ(beside.model().statistics().ghosts_now, 1U);
  EXPECT_LT((beside.position(1) - alone.position(1)).norm(), 2e-5);
  EXPECT_LT((beside.velocity(1) - alone.velocity(1)).norm(), 2e-5);
}

class BouncingBall : public testing::TestWithParam<double> {};

/// Ratio of the speeds after and before the first impact of a ball dropped from `height` over the floor.
double rebound(double e, double dt, double height) {
  ModelRun run(scene_of(spheres(fmt::format("{{id: 1, at: [0, 0, {:.12g}]}}", 0.1 + height),
                                fmt::format("restitution: {}", e), floor_at_zero),
                        {set("dt", dt)}));
  double fastest = 0;
  while (run.velocity(1).z() <= fastest && run.time() < 2) {
    fastest = run.velocity(1).z();
    run.steps(1);
  }
  if (e == 0) run.steps(2);  // one that is to stay is let down to the floor first
  return run.velocity(1).z() / -fastest;
}

struct Spread {
  double low = 9, mean = 0, high = -9;
};

/// Over 20 phases of the time step.
Spread rebounds(double e, double dt) {
  Spread s;
  for (int phase = 0; phase < 20; ++phase) {
    const double got = rebound(e, dt, 1 + 4.43 * dt * phase / 20);
    s.low = std::min(s.low, got);
    s.high = std::max(s.high, got);
    s.mean += got / 20;
  }
  testing::Test::RecordProperty(fmt::format("rebound_dt_{:.0f}us", 1e6 * dt),
                                fmt::format("{:.4f} {:.4f} {:.4f}", s.low, s.mean, s.high));
  return s;
}

TEST_P(BouncingBall, ComesBackWithItsRestitution) {
  const double e = GetParam();
  for (const double dt : {1.0 / 60, 1.0 / 240, 1e-3}) {
    const Spread got = rebounds(e, dt);
    EXPECT_LT(got.high, e + 1e-4) << dt;
    EXPECT_GT(got.low, e - 1e-4) << dt;
  }
}

/// An elastic ball that is found z below the floor leaves from there with the speed it has: each impact may change the
/// energy m g h by up to m g z, z being the way of a step. First order in the step.
TEST(ElasticBall, KeepsItsEnergyToFirstOrder) {
  for (const double dt : {1.0 / 240, 1e-3}) {
    ModelRun run(scene_of(spheres("{id: 1, at: [0, 0, 1.1]}", "restitution: 1", floor_at_zero), {set("dt", dt)}));
    const auto energy = [&] { return 9.81 * (run.position(1).z() - 0.1) + 0.5 * run.velocity(1).squaredNorm(); };
    const double before = energy();
    run.steps(std::lround(10 / dt));  // 11 impacts
    RecordProperty(fmt::format("energy_dt_{:.0f}us", 1e6 * dt), fmt::format("{:.4f}", energy() / before));
    EXPECT_NEAR(energy(), before, 11 * 9.81 * 4.43 * dt) << dt;
  }
}

INSTANTIATE_TEST_SUITE_P(All, BouncingBall, testing::Values(0.0, 0.3, 0.5, 0.8, 1.0),
                         [](const auto& test) { return fmt::format("e{:.0f}", 100 * test.param); });

}  // namespace
}  // namespace moraine
