// SPDX-License-Identifier: Apache-2.0
// Two bodies meet: head-on and oblique, in one sub-model and in two.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::impulse_engines;
using test::ModelRun;
using test::set;
using test::spheres;
using test::weightless;

struct HeadOn {
  double m1, m2, v1, v2, e;
};

void PrintTo(const HeadOn& c, std::ostream* out) { *out << c.m1 << " kg on " << c.m2 << " kg, e " << c.e; }

class HeadOnImpact : public testing::TestWithParam<std::tuple<HeadOn, int, std::string>> {};

/// v1' = v_c - e m2/(m1 + m2) (v1 - v2) and v2' alike, at 20 phases of the time step. Momentum is kept to 1e-6, to
/// 1.5e-6 where one is a thousand times heavier. In two sub-models one sphere meets a ghost of half the mass: a
/// restitution of 1 becomes 0.58 for equal masses, one of 0.5 is up to 0.13 off.
TEST_P(HeadOnImpact, KeepsMomentumAndRestitution) {
  const auto& [c, parts, engine] = GetParam();
  const double total = c.m1 + c.m2, closing = c.v1 - c.v2;
  const double centre = (c.m1 * c.v1 + c.m2 * c.v2) / total;
  double worst_momentum = 0, worst_restitution = 0;
  for (int phase = 0; phase < 20; ++phase) {
    const double start = -0.15 - closing * 1e-3 * phase / 20;
    ModelRun run(scene_of(spheres(fmt::format("{{id: 1, at: [{}, 0, 0], velocity: [{}, 0, 0], mass: {}}}, "
                                              "{{id: 2, at: [0.1, 0, 0], velocity: [{}, 0, 0], mass: {}}}",
                                              start, c.v1, c.m1, c.v2, c.m2),
                                  fmt::format("restitution: {}", c.e), weightless + "run: {split: slabs}\n"),
                          {set("run.sub_models", parts), set("run.engine", engine)}));
    run.steps(std::lround(0.2 / closing / 1e-3));
    const double v1 = run.velocity(1).x(), v2 = run.velocity(2).x();
    const double scale = c.m1 * std::abs(c.v1) + c.m2 * std::abs(c.v2);
    worst_momentum = std::max(worst_momentum, std::abs(c.m1 * v1 + c.m2 * v2 - total * centre) / scale);
    worst_restitution = std::max(worst_restitution, std::abs((v2 - v1) / closing - c.e));
    EXPECT_LT(run.velocity(1).tail<2>().norm(), 1e-5);
  }
  RecordProperty("momentum", fmt::format("{:.2e}", worst_momentum));
  RecordProperty("restitution", fmt::format("{:.2e}", worst_restitution));
  EXPECT_LT(worst_momentum, 3e-6);
  EXPECT_LT(worst_restitution, parts == 1 ? 1e-4 : 0.45);
}

const std::vector<HeadOn> head_on = {
    {1, 1, 1, 0, 1}, {1, 1, 1, 0, 0.5}, {2, 1, 1, -1, 0.5}, {1, 1000, 1, 0, 1}, {1, 1e6, 10, 0, 0.5},
};

INSTANTIATE_TEST_SUITE_P(Table, HeadOnImpact,
                         testing::Combine(testing::ValuesIn(head_on), testing::Values(1, 2),
                                          testing::ValuesIn(impulse_engines)),
                         [](const auto& test) {
                           const HeadOn& c = std::get<0>(test.param);
                           return fmt::format("m{:.0f}_m{:.0f}_v{:.0f}_e{:.0f}_in{}_{}", c.m1, c.m2, c.v1, 100 * c.e,
                                              std::get<1>(test.param), std::get<2>(test.param));
                         });

struct Target {
  const char* name;
  std::string_view boundary;  ///< a surface through the origin, facing up; none: an equal sphere that flies towards
};

void PrintTo(const Target& t, std::ostream* out) { *out << t.name; }

const Target targets[] = {
    {"plane", "{plane: {point: [0, 0, 0], normal: [0, 0, 1]}}"},
    {"box", "{plate: {size: [2, 2, 1], at: [0, 0, -0.5]}}"},
    {"mesh", "{mesh: {vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], triangles: [[0, 1, 2], [0, 2, 3]]}}"},
    {"sphere", ""},
};

struct Rebound {
  double along = 0, across = 0;  ///< speeds after the impact, as parts of the speed before
};

/// A sphere of radius 0.1 m comes straight down at 1 m/s and is `gap` away; after the impact it flies on for 0.2 s.
Rebound rebound(const std::string& engine, const Target& target, double e, double dt, double gap) {
  const bool pair = target.boundary.empty();
  const std::string other =
      pair ? fmt::format(", {{id: 2, at: [0.03, 0.02, {}], velocity: [0, 0, 1]}}", -0.1 - gap) : "";
  ModelRun run(scene_of(spheres(fmt::format("{{id: 1, at: [0.03, 0.02, {}], velocity: [0, 0, -1]}}", 0.1 + gap) + other,
                                fmt::format("restitution: {}", e),
                                weightless + (pair ? "" : fmt::format("boundaries: [{}]\n", target.boundary))),
                        {set("dt", dt), set("run.engine", engine)}));
  run.steps(std::lround((gap + 0.2) / dt));
  return {run.velocity(1).z(), run.velocity(1).head<2>().norm()};
}

class Restitution : public testing::TestWithParam<std::tuple<Target, double, double, std::string>> {};

/// v' = -e v, whatever the step and whatever is hit, at 7 phases of the step.
TEST_P(Restitution, IsReached) {
  const auto& [target, e, dt, engine] = GetParam();
  Rebound worst;
  for (int phase = 0; phase < 7; ++phase) {
    const Rebound r = rebound(engine, target, e, dt, 0.05 + dt * phase / 7);
    worst.along = std::max(worst.along, std::abs(r.along - e));
    worst.across = std::max(worst.across, r.across);
  }
  RecordProperty("along", fmt::format("{:.1e}", worst.along));
  EXPECT_LT(worst.along, 1e-4);
  EXPECT_LT(worst.across, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Table, Restitution,
                         testing::Combine(testing::ValuesIn(targets), testing::Values(0.0, 0.5, 1.0),
                                          testing::Values(1.0 / 60, 1.0 / 240, 1e-3, 1e-4),
                                          testing::ValuesIn(impulse_engines)),
                         [](const auto& test) {
                           return fmt::format("{}_e{:.0f}_dt{:.0f}us_{}", std::get<0>(test.param).name,
                                              100 * std::get<1>(test.param), 1e6 * std::get<2>(test.param),
                                              std::get<3>(test.param));
                         });

class ElasticGas : public testing::TestWithParam<std::string> {};

/// Energy after 15 s, thousands of impacts, as a part of that at the start.
double energy_kept(const std::string& engine, int parts) {
  ModelRun run(scene_of(R"(gravity: [0, 0, 0]
materials: {ball: {density: 1, friction: 0, restitution: 1}}
elements:
  - {packing: cubic, shape: {sphere: 0.5}, cells: [6, 6, 6], spacing: 1.6, at: [0.3, 0.3, 0.3], jitter: 0.2, seed: 1,
     velocity: [1, 0.6, 0.3], material: ball}
boundaries: [{box: [[0, 0, 0], [10, 10, 10]], material: ball}]
time: {dt: 1 / 240, duration: 15}
)",
                        {set("run.engine", engine), set("run.sub_models", parts)}));
  const double before = run.kinetic_energy();
  run.go();
  const double kept = run.kinetic_energy() / before;
  testing::Test::RecordProperty(fmt::format("energy_in_{}", parts), fmt::format("{:.6f}", kept));
  return kept;
}

/// Measured: bullet loses 6e-4, impulse gains 8.8e-3.
TEST_P(ElasticGas, KeepsItsEnergy) {
  EXPECT_NEAR(energy_kept(GetParam(), 1), 1, std::string_view(GetParam()) == "impulse" ? 1e-2 : 2e-3);
}

/// Spheres that meet others in two worlds at once lose some: 9 and 11 %.
TEST_P(ElasticGas, KeepsMostOfItsEnergyWhenCut) { EXPECT_NEAR(energy_kept(GetParam(), 4), 1, 0.15); }

INSTANTIATE_TEST_SUITE_P(Engines, ElasticGas, testing::ValuesIn(impulse_engines),
                         [](const auto& test) { return test.param; });

struct Oblique {
  double friction, tangential, spin;  ///< expected v_t' and |w R|
};

void PrintTo(const Oblique& c, std::ostream* out) { *out << "mu " << c.friction; }

class ObliqueImpact : public testing::TestWithParam<std::tuple<Oblique, int, std::string>> {};

struct Budget {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero(), angular_far = Vec3::Zero();
  double energy = 0;
};

Budget budget(const ModelRun& run) {
  Budget b;
  const double inertia = 0.4 * 0.1 * 0.1;
  for (const ElementId id : {1U, 2U}) {
    const Vec3 v = run.velocity(id), w = run.spin(id), x = run.position(id);
    b.linear += v;
    b.angular += x.cross(v) + inertia * w;
    b.angular_far += (x - Vec3(100, 0, 0)).cross(v) + inertia * w;
    b.energy += 0.5 * v.squaredNorm() + 0.5 * inertia * w.squaredNorm();
  }
  return b;
}

/// Each ball comes with 1 m/s along and 0.9 m/s across the line of centres; e = 0.8. Met just as they touch, the whole
/// model is right to 2e-4. In two sub-models they part with 0.54 m/s instead of 0.8, and friction is off by 10 %.
TEST_P(ObliqueImpact, SlidesOrSticksAndKeepsMomenta) {
  const auto& [c, parts, engine] = GetParam();
  const double time = 0.02 - 1e-5;  // until they touch, just inside a step
  ModelRun run(
      scene_of(spheres(fmt::format("{{id: 1, at: [{0}, {1}, 0], velocity: [1, 0.9, 0]}}, "
                                   "{{id: 2, at: [{2}, {3}, 0], velocity: [-1, -0.9, 0]}}",
                                   -0.1 - time, -0.9 * time, 0.1 + time, 0.9 * time),
                       fmt::format("restitution: 0.8, friction: {}", c.friction), weightless + "run: {split: slabs}\n"),
               {set("run.sub_models", parts), set("run.engine", engine)}));
  const Budget before = budget(run);
  run.steps(100);
  const Budget after = budget(run);
  EXPECT_NEAR(run.velocity(1).x(), -0.8, parts == 1 ? 3e-4 : 0.27);
  EXPECT_NEAR(run.velocity(1).y(), c.tangential, parts == 1 ? 3e-4 : 0.03);
  EXPECT_NEAR(std::abs(run.spin(1).z()) * 0.1, c.spin, parts == 1 ? 3e-4 : 0.05);
  EXPECT_LT((after.linear - before.linear).norm(), 1e-6 * 2 * std::hypot(1, 0.9));
  const bool loose = parts == 2 && std::string_view(engine) == "impulse";  // measured: 4e-4
  EXPECT_LT((after.angular - before.angular).norm(), loose ? 6e-4 : 1e-5);
  EXPECT_LT((after.angular_far - before.angular_far).norm(), loose ? 6e-4 : 1e-4) << "about a point 100 m away";
  EXPECT_LE(after.energy, before.energy * (1 + 1e-6));
}

const std::vector<Oblique> oblique = {{0, 0.9, 0}, {0.05, 0.81, 0.225}, {0.2, 0.642857, 0.642857}};

INSTANTIATE_TEST_SUITE_P(Table, ObliqueImpact,
                         testing::Combine(testing::ValuesIn(oblique), testing::Values(1, 2),
                                          testing::ValuesIn(impulse_engines)),
                         [](const auto& test) {
                           return fmt::format("mu{:.0f}_in{}_{}", 100 * std::get<0>(test.param).friction,
                                              std::get<1>(test.param), std::get<2>(test.param));
                         });

}  // namespace
}  // namespace moraine
