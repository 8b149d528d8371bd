// SPDX-License-Identifier: Apache-2.0
// Impacts of soft spheres: how long they last, how fast they part, what they turn into spin.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"
#include "tests/support/single_world.hpp"

namespace moraine {
namespace {

using std::numbers::pi;
using test::set;
using test::SingleWorld;
using test::spheres;
using test::weightless;

const Engine& soft() { return find_engine("soft_sphere"); }

/// Steps until the two have met and parted: how long they touched [s].
double watch(SingleWorld& w, int most_substeps) {
  int substeps = 0;
  for (int k = 0; k < most_substeps && (substeps == 0 || w.world().work().contacts > 0); ++k) {
    w.substeps(1);
    if (w.world().work().contacts > 0) ++substeps;
  }
  return substeps * w.substep();
}

struct Pair {
  double m1, m2, restitution;
};
void PrintTo(const Pair& p, std::ostream* out) { *out << p.m1 << " and " << p.m2 << " kg, e " << p.restitution; }

class LinearImpact : public testing::TestWithParam<Pair> {};

double damping_ratio(double e) { return -std::log(e) / std::hypot(pi, std::log(e)); }

/// A linear spring and dashpot is a half swing: it lasts pi / (w0 sqrt(1 - zeta^2)), w0^2 = k / m*, and returns the
/// share e. At 20 phases of a substep of 1/200 of it.
TEST_P(LinearImpact, LastsAndReturnsWhatTheFormulaSays) {
  const auto [m1, m2, e] = GetParam();
  const double k = 1e5, reduced = m1 * m2 / (m1 + m2), zeta = damping_ratio(e);
  const double duration = pi / std::sqrt(k / reduced * (1 - zeta * zeta)), h = duration / 200;
  for (int phase = 0; phase < 20; ++phase) {
    SingleWorld w(soft(), scene_of(spheres(fmt::format("{{id: 1, at: [{}, 0, 0], velocity: [1, 0, 0], mass: {}}}, "
                                                       "{{id: 2, at: [0.1, 0, 0], mass: {}}}",
                                                       -0.1 - h * (1 + phase / 20.0), m1, m2),
                                           fmt::format("normal_stiffness: {}, restitution: {}", k, e), weightless),
                                   {set("dt", h)}));
    EXPECT_NEAR(watch(w, 1000), duration, 2 * h) << phase;
    const double v1 = w.velocity(1).x(), v2 = w.velocity(2).x();
    EXPECT_NEAR(v2 - v1, e, 0.005) << phase;
    EXPECT_NEAR(m1 * v1 + m2 * v2, m1, 1e-12 * m1) << phase;
  }
}

INSTANTIATE_TEST_SUITE_P(Table, LinearImpact,
                         testing::Values(Pair{1, 1, 1}, Pair{1, 1, 0.8}, Pair{1, 1, 0.5}, Pair{2, 1, 0.2},
                                         Pair{1, 1000, 0.5}),
                         [](const auto& test) {
                           return fmt::format("m{:.0f}_m{:.0f}_e{:.0f}", test.param.m1, test.param.m2,
                                              100 * test.param.restitution);
                         });

/// The largest deviation from the speed of approach over 40 phases of a substep.
double worst_rebound(double substeps_per_contact) {
  const double k = 1e5, h = pi / std::sqrt(2 * k) / substeps_per_contact;
  double worst = 0;
  for (int phase = 0; phase < 40; ++phase) {
    SingleWorld w(soft(), scene_of(spheres(fmt::format("{{id: 1, at: [{}, 0, 0], velocity: [1, 0, 0]}}, "
                                                       "{{id: 2, at: [0.1, 0, 0]}}",
                                                       -0.1 - h * (1 + phase / 40.0)),
                                           fmt::format("normal_stiffness: {}, restitution: 1", k), weightless),
                                   {set("dt", h)}));
    watch(w, 4000);
    worst = std::max(worst, std::abs(w.velocity(2).x() - w.velocity(1).x() - 1));
  }
  return worst;
}

/// Half the step, a quarter of the error.
TEST(SoftImpact, KeepsEnergyToSecondOrderWithoutDamping) {
  const double coarse = worst_rebound(20), middle = worst_rebound(40), fine = worst_rebound(80);
  EXPECT_LT(coarse, 0.02);
  EXPECT_GT(coarse / middle, 3.3);
  EXPECT_GT(middle / fine, 3.3);
}

struct Budget {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double energy = 0;
};

Budget budget(const SingleWorld& w, const Vec3& about) {
  Budget b;
  const double inertia = 0.4 * 0.01;
  for (const ElementId id : {1U, 2U}) {
    const ElementState s = w.state(id);
    const Vec3& v = s.twist.linear;
    const Vec3& spin = s.twist.angular;
    b.linear += v;
    b.angular += (s.pose.position - about).cross(v) + inertia * spin;
    b.energy += 0.5 * v.squaredNorm() + 0.5 * inertia * spin.squaredNorm();
  }
  return b;
}

/// Each ball comes with 1 m/s along and 0.9 m/s across the line of centres; e = 0.8. With mu = 0.05 it slides all the
/// time: v_t' = 0.9 - mu 1.8, |w R| = 5/2 mu 1.8. Momenta are exact, about a point far away too.
TEST(SoftImpact, ObliqueKeepsMomentaAndSlides) {
  for (const double friction : {0.05, 0.2, 1.0}) {
    SingleWorld w(
        soft(),
        scene_of(spheres("{id: 1, at: [-0.1005, -0.00045, 0], velocity: [1, 0.9, 0]}, "
                         "{id: 2, at: [0.1005, 0.00045, 0], velocity: [-1, -0.9, 0]}",
                         fmt::format("normal_stiffness: 1e9, restitution: 0.8, friction: {}", friction), weightless),
                 {set("dt", 5e-7)}));
    const Vec3 far(100, 0, 0);
    const Budget before = budget(w, Vec3::Zero()), before_far = budget(w, far);
    w.steps(3000);
    const Budget after = budget(w, Vec3::Zero()), after_far = budget(w, far);
    EXPECT_NEAR(w.velocity(1).x(), -0.8, 0.005);
    if (friction == 0.05) {
      EXPECT_NEAR(w.velocity(1).y(), 0.81, 0.002);
      EXPECT_NEAR(std::abs(w.state(1).twist.angular.z()) * 0.1, 0.225, 0.003);
    }
    EXPECT_LT((after.linear - before.linear).norm(), 1e-12);
    EXPECT_LT((after.angular - before.angular).norm(), 1e-12);
    EXPECT_LT((after_far.angular - before_far.angular).norm(), 1e-10);
    EXPECT_LT(after.energy, before.energy);
  }
}

}  // namespace
}  // namespace moraine
