// SPDX-License-Identifier: Apache-2.0
// Tall stacks, heavy on light, deep overlaps, stiff bonds: loads that solvers carry badly.
#include "tests/extremes/outcome.hpp"

namespace moraine::test {
namespace {

constexpr double g = 9.81;

/// Spheres of 1 m and 1 kg, one on top of the other.
std::string stack(int n) {
  return fmt::format(
      "materials: {{ball: {{density: 1, restitution: 0}}}}\n"
      "elements: [{{packing: cubic, shape: {{sphere: 0.5}}, mass: 1, cells: [1, 1, {}], at: [-0.5, -0.5, 0]}}]\n"
      "{}time: {{dt: 1, steps: 1}}\nrun: {{sub_models: 1}}\n",
      n, floor_at_zero);
}

double height_lost(const Outcome& o) {
  double sum = 0;
  for (std::size_t i = 0; i < o.states.size(); ++i) sum += static_cast<double>(i) + 0.5 - o.position(i).z();
  return sum / (0.5 * static_cast<double>(o.states.size()) * static_cast<double>(o.states.size()));
}

class Stack : public testing::TestWithParam<std::tuple<std::string, int>> {};

/// Until it stands still. Soft spheres are a spring that is damped only where they touch: the slowest swing of a column
/// has 1/n of the frequency of a contact and 1/n of its damping ratio, so 100 of them still swing after 10 s.
double settling_time(const std::string& engine, int n) { return engine == "soft_sphere" && n > 50 ? 40 : 10; }

/// Stands, loses less than 1 % of its height, and the floor carries it.
TEST_P(Stack, Stands) {
  const auto [engine, n] = GetParam();
  const std::string scene = stack(n);
  const Outcome o = attempt(scene, for_time(scene, engine, settling_time(engine, n), 1.0 / 240));
  ASSERT_TRUE(o.ran()) << o.text;
  const double lost = height_lost(o), force = o.statistics.boundary_force.z() / (n * g);
  record("X1 stack", engine, fmt::format("{} spheres", n), o.ending(),
         fmt::format("{:.2g} of its height lost, floor carries {:.4f}, overlap {:.2g}", lost, force, o.overlaps.max));
  expect_no_silent_gain(o);
  EXPECT_LT(std::abs(lost), 0.01);
  EXPECT_NEAR(force, 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(All, Stack, testing::Combine(testing::ValuesIn(all_engines), testing::Values(2, 10, 50, 100)),
                         ByEngine{});

/// One ball of mass `heavy` on one of 1 kg.
std::string pair(const std::string& below, const std::string& above) {
  return fmt::format(
      "materials: {{ball: {{density: 1, restitution: 0}}}}\n"
      "elements: [{{packing: list, shape: {{sphere: 0.5}}, items: [{{id: 1, at: [0, 0, 0.5], mass: {}}}, "
      "{{id: 2, at: [0, 0, 1.5], mass: {}}}]}}]\n{}time: {{dt: 1, steps: 1}}\nrun: {{sub_models: 1}}\n",
      below, above, floor_at_zero);
}

/// Steps get as short as the light one needs, so the span does too.
double span(const std::string& engine, double ratio) { return engine == "soft_sphere" && ratio > 1e3 ? 0.05 : 2; }

class MassRatio : public testing::TestWithParam<std::tuple<std::string, double>> {};

/// Overlaps stay below 5 % up to a ratio of 1000; beyond, bodies sink or it is said that they do. The sweeps of impulse
/// push the light one into the floor: from 1e4 on its centre stays 0.74 radii behind it.
TEST_P(MassRatio, HeavyOnLight) {
  const auto [engine, ratio] = GetParam();
  const std::string scene = pair("1", fmt::format("{:.17g}", ratio));
  const Outcome o = attempt(scene, for_time(scene, engine, span(engine, ratio), 1.0 / 240));
  record("X2 heavy on light", engine, fmt::format("{:.0e}", ratio), o.ending(),
         o.ran() ? fmt::format("overlap {:.2g}", o.overlaps.max) : o.text);
  expect_no_silent_gain(o);
  ASSERT_TRUE(o.ran() || (ratio > 1e3 && o.says("escape: "))) << o.text;
  if (!o.ran()) return;
  EXPECT_GT(o.position(0).z(), o.warned("escape: ") ? -0.4 : 0);
  if (ratio <= 1e3 || o.warnings.empty()) {
    EXPECT_LT(o.overlaps.max, 0.05);
  }
}

TEST_P(MassRatio, LightOnHeavy) {
  const auto [engine, ratio] = GetParam();
  const std::string scene = pair(fmt::format("{:.17g}", ratio), "1");
  const Outcome o = attempt(scene, for_time(scene, engine, span(engine, ratio), 1.0 / 240));
  record("X2 light on heavy", engine, fmt::format("{:.0e}", ratio), o.ending(),
         o.ran() ? fmt::format("overlap {:.2g}", o.overlaps.max) : o.text);
  expect_no_silent_gain(o);
  ASSERT_TRUE(o.ran()) << o.text;
  EXPECT_LT(o.overlaps.max, 0.05);
}

INSTANTIATE_TEST_SUITE_P(All, MassRatio,
                         testing::Combine(testing::ValuesIn(all_engines), testing::Values(10, 1e2, 1e3, 1e4, 1e6)),
                         ByEngine{});

class DeepOverlap : public testing::TestWithParam<std::tuple<std::string, double>> {};

/// Two spheres that overlap by a share of their diameter at the start, far above the floor.
std::string overlapping(double share) {
  return fmt::format(
      "materials: {{ball: {{density: 1, restitution: 0.5}}}}\n"
      "elements: [{{packing: list, shape: {{sphere: 0.5}}, mass: 1, items: [{{id: 1, at: [0, 0, 10.5]}}, "
      "{{id: 2, at: [0, {:.17g}, 10.5]}}]}}]\n{}time: {{dt: 1, steps: 1}}\nrun: {{sub_models: 1}}\n",
      1 - share, floor_at_zero);
}

void expect_springs_refuse(const Outcome& o, const std::string& engine) {
  expect_end(o, engine != "soft_sphere", "would throw them apart");
}

/// The overlap is reported, and they part slower than a few sqrt(g d), or the run is refused.
TEST_P(DeepOverlap, PartsSlowlyOrIsRefused) {
  const auto [engine, share] = GetParam();
  const std::string scene = overlapping(share);
  const Outcome o = attempt(scene, for_time(scene, engine, 0.5, 1.0 / 240));
  const double speed = o.ran() ? (o.velocity(0) - o.velocity(1)).norm() / std::sqrt(g) : 0;
  record("X7 deep overlap", engine, fmt::format("{:.0f} %", 100 * share), o.ending(),
         o.ran() ? fmt::format("parts at {:.2g} sqrt(g d)", speed) : o.text);
  expect_springs_refuse(o, engine);
  if (!o.ran()) return;
  EXPECT_TRUE(o.warned("overlap")) << "somebody must say so";
  EXPECT_LT(speed, 3);
  EXPECT_GT((o.position(0) - o.position(1)).norm(), 1 - share) << "they do part, identical places too";
}

/// The same bits again: identical centres have a direction that is always the same.
TEST_P(DeepOverlap, IsTheSameEveryTime) {
  const auto [engine, share] = GetParam();
  const std::string scene = overlapping(share);
  const auto settings = for_time(scene, engine, 0.5, 1.0 / 240);
  const Outcome a = attempt(scene, settings), b = attempt(scene, settings);
  expect_springs_refuse(a, engine);
  ASSERT_EQ(a.states.size(), b.states.size());
  for (std::size_t i = 0; i < a.states.size(); ++i) EXPECT_EQ(a.position(i), b.position(i));
}

INSTANTIATE_TEST_SUITE_P(All, DeepOverlap,
                         testing::Combine(testing::ValuesIn(all_engines), testing::Values(0.1, 0.5, 0.99, 1.0)),
                         ByEngine{});

class StiffBond : public testing::TestWithParam<std::tuple<std::string, double>> {};

/// Energy of a bond that swings, at most, in parts of what it is on average: an explicit step keeps
/// v^2 + (w x)^2 - h w^2 x v, an implicit one loses.
double swing(const std::string& engine, double hw) {
  return engine == "soft_sphere" ? 1 / (1 - hw / 2) : 1 + std::min(0.5, hw) / 2;
}

/// Two bonded balls that swing, the bond's h w from 0.1 to 100: energy never grows, or the step is refused. They never
/// touch, so contacts are soft and leave the step to the bond.
TEST_P(StiffBond, NeverGainsEnergy) {
  const auto [engine, hw] = GetParam();
  const double h = 1e-3, k = 0.5 * hw * hw / (h * h);
  const std::string scene = fmt::format(
      "gravity: [0, 0, 0]\nmaterials: {{ball: {{density: 1, normal_stiffness: 1}}}}\n"
      "elements: [{{packing: list, shape: {{sphere: 0.1}}, mass: 1, items: [{{id: 1, at: [-0.5, 0, 0], velocity: [1, "
      "0.5, 0]}}, {{id: 2, at: [0.5, 0, 0], velocity: [-1, 0, 0]}}]}}]\nbonds: [{{a: 1, b: 2, stiffness: {:.17g}}}]\n"
      "time: {{dt: {}, steps: 2000}}\nrun: {{sub_models: 1, engine: {}}}\n",
      k, h, engine);
  const Outcome o = attempt(scene, {});
  const EnergyAccount& e = o.statistics.energy;
  record("X9 stiff bond", engine, fmt::format("h w = {:.3g}", hw), o.ending(),
         o.ran() ? fmt::format("{:.2f} of its energy left", (e.kinetic + e.bond) / 1.125) : o.text);
  expect_end(o, engine != "soft_sphere" || hw < 2, "set by bonds of element");
  if (!o.ran()) return;
  EXPECT_LT(e.kinetic + e.bond, 1.125 * (swing(engine, hw) + 0.01));
  EXPECT_NEAR((o.velocity(0) + o.velocity(1)).y(), 0.5, 1e-4) << "momentum";
  if (hw > 1) {
    EXPECT_TRUE(o.warned(engine == std::string("soft_sphere") ? "energy: " : "substep: ")) << "it swings, or is damped";
  }
}

INSTANTIATE_TEST_SUITE_P(All, StiffBond,
                         testing::Combine(testing::ValuesIn(all_engines), testing::Values(0.1, 0.4, 1.5, 5, 30, 100)),
                         ByEngine{});

}  // namespace
}  // namespace moraine::test
