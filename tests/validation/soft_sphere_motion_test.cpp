// SPDX-License-Identifier: Apache-2.0
// Soft spheres that fly, slide, roll and hang on bonds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/soft_sphere/step_limit.hpp"
#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using std::numbers::pi;
using test::floor_at_zero;
using test::ModelRun;
using test::set;
using test::spheres;
using test::weightless;

const std::string soft = "run: {engine: soft_sphere}\n";

/// Verlet integration of a constant acceleration is exact.
TEST(SoftMotion, FreeFallIsExact) {
  ModelRun run(
      scene_of(spheres("{id: 1, at: [0, 0, 100], velocity: [3, 0, 4]}", "restitution: 1", soft), {set("dt", 2e-4)}));
  run.steps(5000);
  EXPECT_LT((run.position(1) - Vec3(3, 0, 100 + 4 - 0.5 * 9.81)).norm(), 1e-11);
  EXPECT_LT((run.velocity(1) - Vec3(3, 0, 4 - 9.81)).norm(), 1e-12);
}

/// It slides with -mu g until t* = 2 v0 / (7 mu g), x* = 12 v0^2 / (49 mu g), and rolls on with 5/7 v0.
TEST(SoftMotion, SlidingBecomesRolling) {
  for (const double mu : {0.1, 0.3}) {
    ModelRun run(scene_of(
        spheres(fmt::format("{{id: 1, at: [0, 0, {:.12f}], velocity: [1, 0, 0]}}", 0.1 - 9.81 / 1e6),
                fmt::format("normal_stiffness: 1e6, restitution: 0.5, friction: {}", mu), floor_at_zero + soft),
        {set("dt", 1e-5)}));
    const double stop = 2 / (7 * mu * 9.81);
    run.steps(std::lround(stop / 2 / 1e-5));
    EXPECT_NEAR(run.velocity(1).x(), 1 - mu * 9.81 * stop / 2, 1e-3);
    run.steps(std::lround(stop / 2 / 1e-5));
    EXPECT_NEAR(run.position(1).x(), 12 / (49 * mu * 9.81), 0.002);
    run.steps(20000);
    EXPECT_NEAR(run.velocity(1).x(), 5.0 / 7, 1e-3);
    EXPECT_NEAR(run.spin(1).y() * 0.1, run.velocity(1).x(), 1e-3);
  }
}

/// Acceleration along a slope of 30 degrees, measured over half a second.
double slope_acceleration(double friction, double rolling) {
  const double angle = pi / 6;
  ModelRun run(scene_of(
      spheres(
          fmt::format("{{id: 1, at: [0, 0, {:.12f}]}}", 0.1 - 9.81 * std::cos(angle) / 1e6),
          fmt::format("normal_stiffness: 1e6, restitution: 0.5, friction: {}, rolling_friction: {}", friction, rolling),
          floor_at_zero + soft +
              fmt::format("gravity: [{}, 0, {}]\n", 9.81 * std::sin(angle), -9.81 * std::cos(angle))),
      {set("dt", 1e-5)}));
  run.steps(50000);
  return run.velocity(1).x() / 0.5;
}

/// It rolls with 5/7 g sin a where mu >= 2/7 tan a = 0.165, and slides with g (sin a - mu cos a) otherwise. Rolling
/// friction takes 5/7 g mu_r cos a, and holds it where mu_r >= tan a = 0.577.
TEST(SoftMotion, RollsSlidesOrStaysOnASlope) {
  const double s = 0.5, c = std::sqrt(0.75);
  EXPECT_NEAR(slope_acceleration(0.3, 0), 5.0 / 7 * 9.81 * s, 0.005);
  EXPECT_NEAR(slope_acceleration(0.1, 0), 9.81 * (s - 0.1 * c), 0.005);
  EXPECT_NEAR(slope_acceleration(0.8, 0.1), 5.0 / 7 * 9.81 * (s - 0.1 * c), 0.02);
  EXPECT_NEAR(slope_acceleration(0.8, 0.6), 0, 1e-3);
}

/// Two balls of 1 kg on a bond of 1000 N/m, stretched by 1 %: T = 2 pi / sqrt(2 k / m) = 0.140496 s.
std::string bonded(double damping) {
  return spheres("{id: 1, at: [0, 0, 0]}, {id: 2, at: [1, 0, 0]}", "normal_stiffness: 1e-6",
                 weightless + soft + fmt::format("bonds: [{{a: 1, b: 2, stiffness: 1000, damping: {}}}]\n", damping));
}

/// The same pair, set swinging by its speed: amplitude 0.01 m between both.
std::string swinging(double damping) {
  const double speed = 0.005 * std::sqrt(2000.0);
  return spheres(
      fmt::format("{{id: 1, at: [0, 0, 0], velocity: [{}, 0, 0]}}, {{id: 2, at: [1, 0, 0], velocity: [{}, 0, 0]}}",
                  -speed, speed),
      "normal_stiffness: 1e-6",
      weightless + soft + fmt::format("bonds: [{{a: 1, b: 2, stiffness: 1000, damping: {}}}]\n", damping));
}

TEST(SoftBond, SwingsWithItsPeriodAndKeepsItsEnergy) {
  const double period = 2 * pi / std::sqrt(2000.0), h = period / 100;
  ModelRun run(scene_of(swinging(0), {set("dt", h)}));
  double before = 0, first = -1, last = -1, largest = 0, largest_late = 0;
  int crossings = 0;
  for (int k = 1; k <= 10000; ++k) {
    run.steps(1);
    const double stretch = run.position(2).x() - run.position(1).x() - 1;
    if (before < 0 && stretch >= 0) {
      last = h * (k - stretch / (stretch - before));
      if (first < 0) first = last;
      ++crossings;
    }
    before = stretch;
    largest = std::max(largest, stretch);
    if (k > 9000) largest_late = std::max(largest_late, stretch);
  }
  ASSERT_GT(crossings, 90);
  EXPECT_NEAR((last - first) / (crossings - 1), period, 1e-3 * period);
  EXPECT_NEAR(largest, 0.01, 1e-4);
  EXPECT_NEAR(largest_late, largest, 1e-5) << "after a hundred periods";
}

/// zeta = 0.044721: the amplitude falls to 0.75482 in a period.
TEST(SoftBond, DampsAsItShould) {
  const double period = 2 * pi / 44.6766, h = period / 1000;
  ModelRun run(scene_of(swinging(2), {set("dt", h)}));
  double largest[2] = {0, 0};
  for (int k = 0; k < 2000; ++k) {
    run.steps(1);
    double& most = largest[k / 1000];
    most = std::max(most, run.position(2).x() - run.position(1).x() - 1);
  }
  EXPECT_NEAR(largest[1] / largest[0], 0.75482, 0.002);
}

/// 2 / w = 0.0447 s for this pair; a step above it is refused with that figure.
TEST(SoftStepLimit, OfABondedPairIsTwoOverItsFrequency) {
  EXPECT_NEAR(soft_sphere::step_limit(scene_of(bonded(0))).substep, 2 / std::sqrt(2000.0), 1e-4);
  EXPECT_NO_THROW(ModelRun(scene_of(bonded(0), {set("dt", 0.0446)})));
  try {
    ModelRun(scene_of(bonded(0), {set("dt", 0.045)}));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("0.0447"), std::string::npos) << e.what();
  }
}

/// Largest kinetic energy per element, in m g d, of a dense block in a box just below its time limit.
double restlessness(const std::string& material, double share) {
  const std::string block =
      "materials: {rock: {density: 1909.86, " + material +
      "}}\nelements:\n  - {packing: hcp, shape: {sphere: 0.5}, cells: [6, 6, 6], at: [0.01, 0.01, 0.01], jitter: "
      "1e-4}\n"
      "boundaries: [{box: [[0, 0, 0], [6.55, 6, 9]]}]\ntime: {dt: 1e-6, steps: 1}\nrun: {engine: soft_sphere}\n";
  const double limit = soft_sphere::step_limit(scene_of(block)).substep;
  ModelRun run(scene_of(block, {set("time.dt", share * limit)}));
  run.steps(std::lround(3 / (share * limit)));
  return run.kinetic_energy() / (216 * 1000 * 9.81);
}

TEST(SoftStepLimit, IsStableJustBelow) {
  EXPECT_LT(restlessness("friction: 0.5, restitution: 0.5", 0.99), 1e-3);
  EXPECT_LT(restlessness("friction: 0.5, restitution: 0", 0.99), 1e-3);
  EXPECT_LT(restlessness("friction: 0.5, restitution: 0.5, young: 1e8", 0.99), 1e-3);
}

/// A stack carries its weight: the floor gives as much as gravity takes.
TEST(SoftRest, FloorCarriesTheWeight) {
  ModelRun run(scene_of(spheres("{id: 1, at: [0, 0, 0.1]}, {id: 2, at: [0, 0, 0.3]}, {id: 3, at: [0, 0, 0.5]}",
                                "restitution: 0.2, friction: 0.3", floor_at_zero + soft),
                        {set("dt", 2e-5)}));
  run.steps(50000);
  EXPECT_NEAR(run.boundary_impulse().z(), 3 * 9.81 * 2e-5, 1e-6 * 3 * 9.81 * 2e-5);
  EXPECT_LT(run.kinetic_energy(), 1e-12);
}

/// Neighbours in a lattice just touch: some overlap by nothing but rounding, or by exactly nothing.
TEST(SoftMotion, HertzSpheresThatJustTouchHaveForces) {
  for (const double radius : {0.005, 0.03, 0.1, 0.7}) {
    ModelRun run(
        scene_of("materials: {grain: {density: 2500, friction: 0.5, young: 1e7}}\nelements:\n  - {packing: hcp, "
                 "shape: {sphere: r}, cells: [12, 12, 12]}\nparameters: {r: 1}\nboundaries: [{plane: {normal: "
                 "[0, 0, 1]}}]\ntime: {dt: 1e-5, steps: 20}\nrun: {engine: soft_sphere}\n",
                 {set("r", radius)}));
    EXPECT_NO_THROW(run.go()) << radius;
  }
}

}  // namespace
}  // namespace moraine
