// SPDX-License-Identifier: Apache-2.0
// Impacts of soft spheres: how long they last, how deep they go, how fast they part, what they turn into spin.
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

/// What happened between the first and the last substep with a contact.
struct Impact {
  double duration = 0;   ///< [s]
  double deepest = 0;    ///< largest overlap [m]
  double strongest = 0;  ///< largest force [N]
};

Impact watch(SingleWorld& w, int most_substeps) {
  Impact seen;
  int substeps = 0;
  for (int k = 0; k < most_substeps && (substeps == 0 || w.world().work().contacts > 0); ++k) {
    w.substeps(1);
    if (w.world().work().contacts == 0) continue;
    ++substeps;
    const Contact c = w.world().contacts().at(0);
    seen.deepest = std::max(seen.deepest, c.overlap);
    seen.strongest = std::max(seen.strongest, c.impulse.norm() / w.substep());
  }
  seen.duration = substeps * w.substep();
  return seen;
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
    const Impact seen = watch(w, 1000);
    EXPECT_NEAR(seen.duration, duration, 2 * h) << phase;
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

/// Hertz (1882): Chung & Ooi (2011), tests 1 and 2.
TEST(HertzImpact, OfEqualGlassSpheres) {
  SingleWorld w(
      soft(), scene_of(weightless +
                       "materials: {glass: {density: 2800, restitution: 1, young: 4.8e10, poisson: 0.2}}\n"
                       "elements:\n  - {packing: list, shape: {sphere: 0.01}, items: [{at: [-0.01001, 0, 0], velocity: "
                       "[10, 0, 0]}, {at: [0.01001, 0, 0], velocity: [-10, 0, 0]}]}\ntime: {dt: 1e-7, steps: 1}\n"));
  const Impact seen = watch(w, 2000);
  EXPECT_NEAR(seen.strongest, 10697, 0.01 * 10697);
  EXPECT_NEAR(seen.deepest, 274.1e-6, 0.005 * 274.1e-6);
  EXPECT_NEAR(seen.duration, 40.35e-6, 0.005 * 40.35e-6);
}

TEST(HertzImpact, OfAnAluminiumSphereOnAPlane) {
  SingleWorld w(
      soft(),
      scene_of(weightless +
               "materials: {ball: {density: 2699, restitution: 1, young: 7e10, poisson: 0.3}, rigid: {density: 1, "
               "restitution: 1, young: 7e15, poisson: 0.3}}\n"
               "elements:\n  - {packing: list, shape: {sphere: 0.1}, material: ball, items: [{at: [0, 0, "
               "0.1000001], velocity: [0, 0, -0.2]}]}\n"
               "boundaries: [{plane: {normal: [0, 0, 1]}, material: rigid}]\ntime: {dt: 1e-6, steps: 1}\n"));
  const Impact seen = watch(w, 3000);
  EXPECT_NEAR(seen.strongest, 11370, 0.01 * 11370);
  EXPECT_NEAR(seen.deepest, 49.72e-6, 0.005 * 49.72e-6);
  EXPECT_NEAR(seen.duration, 731.8e-6, 0.005 * 731.8e-6);
}

TEST(HertzImpact, ReturnsTheStatedShare) {
  for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    SingleWorld w(soft(), scene_of(weightless +
                                   fmt::format("materials: {{ball: {{density: 4000, restitution: {}, young: 3.8e11, "
                                               "poisson: 0.23}}}}\n",
                                               e) +
                                   "elements:\n  - {packing: list, shape: {sphere: 0.0025}, items: [{at: [0, 0, "
                                   "0.002501], velocity: [0, 0, -3.9]}]}\n"
                                   "boundaries: [{plane: {normal: [0, 0, 1]}}]\ntime: {dt: 1e-8, steps: 1}\n"));
    watch(w, 4000);
    EXPECT_NEAR(w.velocity(0).z() / 3.9, e, 0.005);
  }
}

struct Angle {
  double degrees;     ///< between the way and the plane's normal
  double tangential;  ///< v_t' / v_t
  double spin;        ///< [rad/s]; 0: not known
  double tolerance;   ///< of v_t' / v_t
};
void PrintTo(const Angle& a, std::ostream* out) { *out << a.degrees << " degrees"; }

class ObliqueHertzImpact : public testing::TestWithParam<Angle> {};

/// Chung & Ooi (2011), test 4: aluminium oxide, r = 2.5 mm, 3.9 m/s, e = 0.98, mu = 0.092. Beyond 32.5 degrees it
/// slides all the time and the answer is rigid-body; below, digitised from the paper, it is the tangential spring's.
TEST_P(ObliqueHertzImpact, TurnsIntoSpinWhatMindlinSays) {
  const Angle& a = GetParam();
  const double angle = a.degrees * pi / 180, vt = 3.9 * std::sin(angle), vn = 3.9 * std::cos(angle);
  SingleWorld w(soft(), scene_of(weightless +
                                 "materials: {ball: {density: 4000, friction: 0.092, restitution: 0.98, young: 3.8e11, "
                                 "poisson: 0.23}}\nelements:\n  - {packing: list, shape: {sphere: 0.0025}, items: [" +
                                 fmt::format("{{at: [0, 0, 0.002501], velocity: [{}, 0, {}]}}]}}\n", vt, -vn) +
                                 "boundaries: [{plane: {normal: [0, 0, 1]}}]\ntime: {dt: 1e-8, steps: 1}\n"));
  watch(w, 4000);
  EXPECT_NEAR(w.velocity(0).z(), 0.98 * vn, 0.005 * vn);
  EXPECT_NEAR(w.velocity(0).x() / vt, a.tangential, a.tolerance);
  const Vec3 spin = w.state(0).twist.angular;
  EXPECT_NEAR(w.velocity(0).x() + 0.4 * 0.0025 * spin.y(), vt, 2e-3 * vt)
      << "about the point of contact, but for the overlap";
  if (a.spin > 0) {
    EXPECT_NEAR(spin.y(), a.spin, 0.01 * a.spin);
  }
}

INSTANTIATE_TEST_SUITE_P(ChungOoi4, ObliqueHertzImpact,
                         testing::Values(Angle{10, 0.687, 0, 0.05}, Angle{15, 0.624, 0, 0.05},
                                         Angle{20, 0.616, 0, 0.05}, Angle{25, 0.634, 0, 0.05},
                                         Angle{30, 0.684, 0, 0.05}, Angle{40, 0.783, 544.2, 0.005},
                                         Angle{50, 0.847, 456.7, 0.005}, Angle{60, 0.895, 355.2, 0.005},
                                         Angle{70, 0.934, 243.0, 0.005}, Angle{80, 0.968, 123.4, 0.005}),
                         [](const auto& test) { return fmt::format("at{:.0f}", test.param.degrees); });

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
