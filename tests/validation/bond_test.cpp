// SPDX-License-Identifier: Apache-2.0
// Bonds: the period and damping of a bonded pair, and where it breaks.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::impulse_engines;
using test::ModelRun;
using test::set;
using test::weightless;

/// Two spheres of 1 kg, 1 m apart, bonded with 1000 N/m, moving apart: stretched by 1 % at the most.
std::string pair(const std::string& bond) {
  return "parameters: {dt: 1e-3, v: 0.01 * sqrt(2000) / 2}\nmaterials: {ball: {density: 1000}}\nelements:\n"
         "  - {packing: list, shape: {sphere: 0.1}, mass: 1, items: [{id: 1, at: [0, 0, 0], velocity: [-v, 0, 0]}, "
         "{id: 2, at: [1, 0, 0], velocity: [v, 0, 0]}]}\ntime: {dt: dt, steps: 1}\n"
         "run: {split: slabs}\nbonds: [{a: 1, b: 2, stiffness: 1000" +
         bond + "}]\n" + weightless;
}

double stretch(const ModelRun& run) { return run.position(2).x() - run.position(1).x() - 1; }

struct Oscillation {
  double period = 0;
  double ratio = 0;  ///< of the amplitudes of successive periods
  double drift = 0;  ///< of the centre of mass [m]
};

/// From zero crossings upwards and the greatest stretches between them.
Oscillation observe(const std::string& bond, double dt, std::vector<Override> setup, int periods) {
  setup.push_back(set("dt", dt));
  ModelRun run(scene_of(pair(bond), setup));
  std::vector<double> crossings, peaks;
  double before = stretch(run), peak = 0;
  while (static_cast<int>(crossings.size()) < periods + 1 && run.time() < 30) {
    run.steps(1);
    const double now = stretch(run);
    peak = std::max(peak, now);
    if (before < 0 && now >= 0) {
      crossings.push_back(run.time() - dt * now / (now - before));
      peaks.push_back(peak);
      peak = 0;
    }
    before = now;
  }
  const auto last = static_cast<double>(crossings.size() - 1);
  return {(crossings.back() - crossings.front()) / last, std::pow(peaks.back() / peaks.front(), 1 / last),
          ((run.position(1) + run.position(2)) / 2 - Vec3(0.5, 0, 0)).norm()};
}

class BondedPair : public testing::TestWithParam<std::tuple<int, std::string>> {
 protected:
  static std::vector<Override> setup() {
    return {set("run.sub_models", std::get<0>(GetParam())), set("run.engine", std::get<1>(GetParam()))};
  }
};

TEST_P(BondedPair, HasItsPeriodAndKeepsItsEnergy) {
  const double period = 2 * std::numbers::pi / std::sqrt(2000.0);
  for (const double dt : {period / 100, period / 20}) {
    const Oscillation o = observe("", dt, setup(), 20);
    EXPECT_NEAR(o.period, period, (dt < period / 50 ? 0.01 : 0.05) * period);
    EXPECT_NEAR(o.ratio, 1, 0.005);
    EXPECT_LT(o.drift, 1e-5);
  }
}

TEST_P(BondedPair, IsDampedAsTheDashpotSays) {
  const double damped = 2 * std::numbers::pi / 44.6766;
  const Oscillation o = observe(", damping: 2", damped / 100, setup(), 8);
  EXPECT_NEAR(o.period, damped, 0.01 * damped);
  EXPECT_NEAR(o.ratio, 0.75482, 0.01);
}

TEST_P(BondedPair, DoesNotOvershootWhenCriticallyDamped) {
  ModelRun run(scene_of(pair(", damping: 44.721"), setup()));
  double least = 0;
  for (int k = 0; k < 1000; ++k) {
    run.steps(1);
    least = std::min(least, stretch(run));
  }
  EXPECT_GT(least, -1e-4 * 0.01 - 1e-6);
}

/// One end is so heavy that it stands; the other is pulled away at 0.01 m/s by one as heavy, bonded to it stiffly.
TEST_P(BondedPair, BreaksAtItsLengthAndStepAndLeavesNoForce) {
  const std::string text =
      "parameters: {k: 1000}\nmaterials: {ball: {density: 1000}}\nelements:\n"
      "  - {packing: list, shape: {sphere: 0.1}, items: [{id: 1, at: [0, 0, 0], mass: 1e7}, {id: 2, at: [1, 0, 0], "
      "velocity: [0.01, 0, 0], mass: 1e7}]}\ntime: {dt: 1e-2, steps: 1}\nrun: {split: slabs}\n"
      "bonds: [{a: 1, b: 2, stiffness: k, break_length: 1.05}]\n" +
      weightless;
  ModelRun run(scene_of(text, setup()));
  run.steps(497);
  EXPECT_EQ(run.model().statistics().bonds_broken, 0U);
  while (run.model().statistics().bonds_broken == 0 && run.time() < 5.1) run.steps(1);
  EXPECT_NEAR(run.time(), 5.0, 2.001e-2);
  const Vec3 after = run.velocity(2);
  run.steps(50);
  EXPECT_LT((run.velocity(2) - after).norm(), 1e-9);
  EXPECT_EQ(run.model().statistics().bonds_broken, 1U);
}

TEST_P(BondedPair, HoldsJustBelowItsLength) {
  ModelRun run(scene_of(pair(", break_length: 1.0101"), setup()));
  run.steps(3000);
  EXPECT_EQ(run.model().statistics().bonds_broken, 0U);
}

INSTANTIATE_TEST_SUITE_P(Parts, BondedPair, testing::Combine(testing::Values(1, 2), testing::ValuesIn(impulse_engines)),
                         [](const auto& test) {
                           return fmt::format("in{}_{}", std::get<0>(test.param), std::get<1>(test.param));
                         });

}  // namespace
}  // namespace moraine
