// SPDX-License-Identifier: Apache-2.0
// Two bodies meet. Where the case is cut, the cut goes through their contact.
#include <fmt/format.h>

#include <cmath>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

constexpr double step = 1e-3;  // s

struct HeadOn {
  double m1, m2, v1, v2, e;
};
constexpr HeadOn head_on[] = {
    {1, 1, 1, 0, 1}, {1, 1, 1, 0, 0.5}, {2, 1, 1, -1, 0.5}, {1, 1000, 1, 0, 1}, {1, 1e6, 10, 0, 0.5}};

struct Met {
  double momentum = 0, restitution = 0;  ///< errors
};

Met meet(const Setting& s, const HeadOn& c, double phase) {
  const double closing = c.v1 - c.v2, gap = 0.05 + closing * step * phase;
  ModelRun run =
      trial(s,
            spheres(fmt::format("{{id: 1, at: [{:.17g}, 0, 0], velocity: [{}, 0, 0], mass: {}}}, {{id: 2, at: "
                                "[0.1, 0, 0], velocity: [{}, 0, 0], mass: {}}}",
                                -0.1 - gap, c.v1, c.m1, c.v2, c.m2),
                    ball(s, fmt::format("restitution: {}", c.e)), weightless),
            step, {}, 0.02);
  run_until(run, 4 * gap / closing);
  const double v1 = run.velocity(1).x(), v2 = run.velocity(2).x();
  return {std::abs(c.m1 * (v1 - c.v1) + c.m2 * (v2 - c.v2)) / (c.m1 * std::abs(c.v1) + c.m2 * std::abs(c.v2)),
          std::abs((v2 - v1) / closing - c.e)};
}

Met worst_meeting(const Setting& s) {
  Met worst;
  for (const HeadOn& c : head_on)
    for (int phase = 0; phase < 5; ++phase) {
      const Met met = meet(s, c, phase / 5.0);
      worst = {worst_of({worst.momentum, met.momentum}), worst_of({worst.restitution, met.restitution})};
    }
  return worst;
}

double head_on_momentum(const Setting& s) { return worst_meeting(s).momentum; }
double head_on_restitution(const Setting& s) { return worst_meeting(s).restitution; }

struct Budget {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  ///< about a point 100 m away
  double energy = 0;
};

Budget budget_of(const ModelRun& run) {
  Budget b;
  constexpr double inertia = 0.4 * 0.1 * 0.1;
  for (const ElementState& e : run.model().states()) {
    b.linear += e.twist.linear;
    b.angular += (e.pose.position - Vec3(100, 0, 0)).cross(e.twist.linear) + inertia * e.twist.angular;
    b.energy += 0.5 * e.twist.linear.squaredNorm() + 0.5 * inertia * e.twist.angular.squaredNorm();
  }
  return b;
}

struct Oblique {
  double friction, tangential, spin;  ///< expected v_t' and |w R|
};
constexpr Oblique oblique[] = {{0.05, 0.81, 0.225}, {0.2, 0.642857, 0.642857}};

ModelRun glance(const Setting& s, const Oblique& c) {
  const double time = 0.02 - 1e-5;  // until they touch
  return trial(
      s,
      spheres(fmt::format("{{id: 1, at: [{0:.17g}, {1:.17g}, 0], velocity: [1, 0.9, 0]}}, {{id: 2, at: [{2:.17g}, "
                          "{3:.17g}, 0], velocity: [-1, -0.9, 0]}}",
                          -0.1 - time, -0.9 * time, 0.1 + time, 0.9 * time),
              ball(s, fmt::format("restitution: 0.8, friction: {}", c.friction)), weightless),
      step);
}

double oblique_speeds(const Setting& s) {
  double most = 0;
  for (const Oblique& c : oblique) {
    if (s.springs() && c.friction > 0.1) continue;  // what sticks on springs swings back
    ModelRun run = glance(s, c);
    run_until(run, 0.1);
    most = worst_of({most, std::abs(run.velocity(1).x() + 0.8), std::abs(run.velocity(1).y() - c.tangential),
                     std::abs(std::abs(run.spin(1).z()) * 0.1 - c.spin)});
  }
  return most;
}

/// Momentum about near and far, and energy gained, relative to what there was.
double oblique_budgets(const Setting& s) {
  double most = 0;
  for (const Oblique& c : oblique) {
    ModelRun run = glance(s, c);
    const Budget before = budget_of(run);
    run_until(run, 0.1);
    const Budget after = budget_of(run);
    const double speed = 2 * std::hypot(1, 0.9);
    most = worst_of({most, (after.linear - before.linear).norm() / speed,
                     (after.angular - before.angular).norm() / (100 * speed), after.energy / before.energy - 1});
  }
  return most;
}

}  // namespace

std::vector<Case> two_bodies() {
  return {
      {"T1 head-on, momentum", "mass ratios 1 to 1e6, five phases of the step", head_on_momentum, 3e-6, 1e-12},
      {"T1 head-on, restitution", "the same: speed after / before", head_on_restitution, 0.02, 0.005},
      {"T2 oblique, speeds", "e = 0.8: slides at mu = 0.05, sticks at 0.2; along, across and spin [m/s]",
       oblique_speeds, 0.02, 0.02},
      {"T2 oblique, budgets", "momenta about a point 100 m away, energy not gained", oblique_budgets, 1e-5, 1e-10},
  };
}

}  // namespace moraine::test
