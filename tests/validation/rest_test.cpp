// SPDX-License-Identifier: Apache-2.0
// Piles at rest: cut ones must stand as quietly as whole ones, and floors must carry the weight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::example;
using test::impulse_engines;
using test::ModelRun;
using test::set;

/// What a pile is like when it has come to rest, averaged over the last 6 s.
struct Rest {
  double energy = 0;       ///< kinetic, per element, in m g d
  double overlap = 0;      ///< largest, in diameters
  double floor_force = 0;  ///< upward force of all boundaries, in weights
  double height = 0;       ///< of the centre of mass [m]
  double residual = 0;     ///< momentum that nothing explains, as a part of what was given
};

Rest settle(const std::string& scene, int parts, double seconds, const std::vector<Override>& more = {}) {
  std::vector<Override> overrides = more;
  overrides.push_back(set("run.sub_models", parts));
  ModelRun run(example(scene, overrides));
  const double dt = run.scene().time.dt;
  const auto steps = [&](double t) { return std::lround(t / dt); };
  run.steps(steps(seconds - 6));
  Rest rest;
  const auto n = static_cast<double>(run.scene().elements.size());
  const double mass = run.scene().typical_mass(), diameter = run.scene().typical_diameter();
  const auto looks = static_cast<double>(steps(6));
  for (int k = 0; k < steps(6); ++k) {
    run.steps(1);
    rest.energy += run.kinetic_energy() / (n * mass * 9.81 * diameter) / looks;
    rest.floor_force += run.boundary_impulse().z() / run.scene().time.substep() / (n * mass * 9.81) / looks;
    rest.overlap = std::max(rest.overlap, run.model().overlaps().max);
  }
  const ModelStatistics s = run.model().statistics();
  rest.height = s.ledger.mass_moment.z() / s.ledger.mass;
  rest.residual = (s.ledger.momentum.linear - s.ledger.given.linear).norm() / s.ledger.exchanged;
  for (const auto& [name, value] : std::map<std::string, double>{{"energy", rest.energy}, {"overlap", rest.overlap}})
    testing::Test::RecordProperty(fmt::format("{}_in_{}_{}", name, parts, more.empty() ? "" : more.front().value),
                                  fmt::format("{:.3e}", value));
  return rest;
}

void expect_sound(const Rest& r, double energy) {
  EXPECT_LT(r.energy, energy);
  EXPECT_LT(r.overlap, 0.02);
  EXPECT_NEAR(r.floor_force, 1, 0.01);
  EXPECT_LT(r.residual, 1e-5);
}

/// `energy`: how many times as much motion a cut may leave. Overlap it may double.
void expect_alike(const Rest& cut, const Rest& whole, double energy = 2) {
  EXPECT_LT(cut.energy, energy * whole.energy);
  EXPECT_LT(cut.overlap, 2 * whole.overlap);
}

/// Into which of many packings a pile settles, and how many of its spheres stay loose, is chance: most of the energy is
/// theirs, and differs between seeds by a thousand times. So geometric means over seeds of the starting positions are
/// compared.
Rest mean_over_seeds(const std::string& scene, int parts, double seconds) {
  constexpr int seeds = 9;
  double energy = 0, overlap = 0, height = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Rest r = settle(scene, parts, seconds, {set("seed", seed)});
    expect_sound(r, 1e-3);
    energy += std::log(r.energy) / seeds;
    overlap += std::log(r.overlap) / seeds;
    height += r.height / seeds;
  }
  Rest mean;
  mean.energy = std::exp(energy);
  mean.overlap = std::exp(overlap);
  mean.height = height;
  return mean;
}

/// Measured over 54 seeds: 1.6 times the energy of the whole. The ratio of means over nine is uncertain by 1.8 times.
TEST(AtRest, BoxSettlesAlikeWholeAndCut) {
  const Rest whole = mean_over_seeds("box_settle", 1, 20), cut = mean_over_seeds("box_settle", 4, 20);
  expect_alike(cut, whole, 3);
  EXPECT_NEAR(cut.height, whole.height, 0.02 * whole.height);
}

TEST(AtRest, ColumnStandsAlikeWholeAndCut) {
  const Rest whole = settle("column", 1, 20), cut = settle("column", 5, 20);
  expect_sound(whole, 1e-6);
  expect_sound(cut, 1e-6);
  expect_alike(cut, whole);
  EXPECT_NEAR(cut.height, whole.height, 1e-3 * whole.height);
}

/// Measured: energy 3e-10 whole and 1.4e-6 cut, overlap 8e-4 and 2.5e-3.
TEST(AtRest, ColumnStandsWithEngineImpulse) {
  const std::vector<Override> engine{set("run.engine", "impulse")};
  const Rest whole = settle("column", 1, 20, engine), cut = settle("column", 5, 20, engine);
  expect_sound(whole, 1e-8);
  expect_sound(cut, 3e-6);
  EXPECT_NEAR(cut.height, whole.height, 1e-3 * whole.height);
}

/// Every sphere of a column a sub-model of its own: the most cuts there can be.
TEST(AtRest, ColumnStandsInPiecesOfOne) {
  ModelRun run(example("column", {set("count", 20), set("run.sub_models", 20), set("run.coupling_leak", 0.7)}));
  run.go();
  const ModelStatistics s = run.model().statistics();
  EXPECT_NEAR(s.ledger.mass_moment.z() / s.ledger.mass, 10, 0.05);
  EXPECT_LT(run.kinetic_energy() / (20 * run.scene().typical_mass() * 9.81), 1e-4);
}

class Hydrostatic : public testing::TestWithParam<std::string> {};

/// Smooth spheres in a smooth box: the floor carries the weight, walls push back alike.
TEST_P(Hydrostatic, FloorCarriesTheWeight) {
  for (const int parts : {1, 3}) {
    ModelRun run(example("box_settle", {set("materials.grain.friction", 0), set("run.sub_models", parts),
                                        set("run.engine", GetParam())}));
    run.steps(6 * 120);
    Vec3 sum = Vec3::Zero();
    const int looks = 2 * 120;
    for (int k = 0; k < looks; ++k) {
      run.steps(1);
      sum += run.boundary_impulse() / run.scene().time.substep() / looks;
    }
    const double weight = static_cast<double>(run.scene().elements.size()) * run.scene().typical_mass() * 9.81;
    EXPECT_NEAR(sum.z(), weight, 0.01 * weight);
    EXPECT_LT(sum.head<2>().norm(), 0.01 * weight);
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, Hydrostatic, testing::ValuesIn(impulse_engines),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace moraine
