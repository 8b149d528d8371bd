// SPDX-License-Identifier: Apache-2.0
// Impacts of Chung & Ooi (2011), Granular Matter 13, 643. With friction and spin: while the surfaces slide all the
// time the answer is that of rigid bodies, for every contact. What sticks has no slip left between rigid bodies;
// springs along the surface swing back, as the curves of the paper say.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

constexpr double step = 1e-3;  // s

/// A value on the abscissa and what is expected there.
struct Point {
  double at, expected;
};

/// What Hertz (1882) says of an elastic impact.
struct Hertz {
  double force = 0, depth = 0, duration = 0;  ///< largest [N], largest [m], [s]
};

std::string hertzian(const Setting& s, double young, double poisson) {
  return s.springs() ? fmt::format(", young: {}, poisson: {}", young, poisson) : "";
}

/// Largest error of the three, each in parts of what is expected of ball 1.
double hertz_error(ModelRun run, double mass, double (*gap)(const ModelRun&), const Hertz& expected) {
  const double dt = run.scene().time.dt;
  Hertz seen;
  while (run.time() < 2 * expected.duration) {
    const Vec3 before = run.velocity(1);
    run.steps(1);
    if (gap(run) >= 0) continue;
    seen.force = std::max(seen.force, mass * (run.velocity(1) - before).norm() / dt);
    seen.depth = std::max(seen.depth, -gap(run));
    seen.duration += dt;
  }
  return worst_of({std::abs(seen.force / expected.force - 1), std::abs(seen.depth / expected.depth - 1),
                   std::abs(seen.duration / expected.duration - 1)});
}

/// Test 1: two balls of glass meet.
double two_balls(const Setting& s) {
  return hertz_error(
      trial(s,
            weightless + "materials: {glass: {density: 2800, restitution: 1" + hertzian(s, 4.8e10, 0.2) +
                "}}\nelements:\n  - {packing: list, shape: {sphere: 0.01}, items: [{id: 1, at: [-0.01001, 0, 0], "
                "velocity: [10, 0, 0]}, {id: 2, at: [0.01001, 0, 0], velocity: [-10, 0, 0]}]}\n"
                "time: {dt: 1e-7, steps: 1}\n",
            1e-7),
      2800 * 4 / 3.0 * std::numbers::pi * 1e-6,
      [](const ModelRun& run) { return run.position(2).x() - run.position(1).x() - 0.02; },
      {10697, 274.1e-6, 40.35e-6});
}

/// Test 2: a ball of aluminium alloy on a plane a hundred thousand times as stiff.
double ball_on_plane(const Setting& s) {
  return hertz_error(
      trial(s,
            weightless + "materials: {ball: {density: 2699, restitution: 1" + hertzian(s, 7e10, 0.3) +
                "}, rigid: {density: 1, restitution: 1" + hertzian(s, 7e15, 0.3) +
                "}}\nelements:\n  - {packing: list, shape: {sphere: 0.1}, material: ball, items: [{id: 1, at: [0, 0, "
                "0.1000001], velocity: [0, 0, -0.2]}]}\n"
                "boundaries: [{plane: {normal: [0, 0, 1]}, material: rigid}]\ntime: {dt: 1e-6, steps: 1}\n",
            1e-6),
      2699 * 4 / 3.0 * std::numbers::pi * 1e-3, [](const ModelRun& run) { return run.position(1).z() - 0.1; },
      {11370, 49.72e-6, 731.8e-6});
}

/// A ball of aluminium oxide comes down on a plane with 3.9 m/s; after 20 us it has left.
ElementState oxide_ball(const Setting& s, const std::string& contact, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  ModelRun run = trial(s,
                       weightless + "materials: {ball: {density: 4000, " + contact + hertzian(s, 3.8e11, 0.23) +
                           "}}\nelements:\n  - {packing: list, shape: {sphere: 0.0025}, items: [" +
                           fmt::format("{{id: 1, at: [0, 0, 0.002501], velocity: [{:.17g}, 0, {:.17g}]}}]}}\n",
                                       3.9 * std::sin(angle), -3.9 * std::cos(angle)) +
                           "boundaries: [{plane: {normal: [0, 0, 1]}}]\ntime: {dt: 1e-6, steps: 1}\n",
                       1e-5);
  run_until(run, s.springs() ? 2e-5 : 5e-4);
  return run.of(1);
}

/// Test 3.
double plane_returns(const Setting& s) {
  double most = 0;
  for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0})
    most = worst_of({most, std::abs(oxide_ball(s, fmt::format("restitution: {}", e), 0).twist.linear.z() / 3.9 - e)});
  return most;
}

struct Angle {
  double degrees, tangential;       ///< v_t' / v_t
  std::optional<double> spin = {};  ///< [rad/s]
};
constexpr Angle sliding[] = {
    {40, 0.783, 544.2}, {50, 0.847, 456.7}, {60, 0.895, 355.2}, {70, 0.934, 243.0}, {80, 0.968, 123.4}};
/// Digitised from the paper's graph.
constexpr Angle sticking[] = {{10, 0.687}, {15, 0.624}, {20, 0.616}, {25, 0.634}, {30, 0.684}};

struct Glance {
  double surface = 0;  ///< of v_t' / v_t and, where it is known, the spin
  double budgets = 0;  ///< of v_n' / v_n and angular momentum about the point of contact
};

/// Test 4: errors. The overlap changes angular momentum a little.
Glance glance(const Setting& s, const Angle& a) {
  const double angle = a.degrees * std::numbers::pi / 180, vt = 3.9 * std::sin(angle), vn = 3.9 * std::cos(angle);
  const Twist t = oxide_ball(s, "friction: 0.092, restitution: 0.98", a.degrees).twist;
  return {
      worst_of({std::abs(t.linear.x() / vt - a.tangential), a.spin ? std::abs(t.angular.y() / *a.spin - 1) : 0}),
      worst_of({std::abs(t.linear.z() / vn - 0.98), std::abs((t.linear.x() + 0.4 * 0.0025 * t.angular.y()) / vt - 1)})};
}

template <const auto& angles>
Glance glances(const Setting& s) {
  Glance most;
  for (const Angle& a : angles) {
    const Glance g = glance(s, a);
    most = {worst_of({most.surface, g.surface}), worst_of({most.budgets, g.budgets})};
  }
  return most;
}

double plane_slides(const Setting& s) { return glances<sliding>(s).surface; }
double plane_swings_back(const Setting& s) { return glances<sticking>(s).surface; }
double plane_budgets(const Setting& s) { return worst_of({glances<sliding>(s).budgets, glances<sticking>(s).budgets}); }

/// Opposite spins: the surfaces that meet have the same speed, so nothing rubs.
double opposite_spins(const Setting& s) {
  ModelRun run =
      trial(s,
            spheres("{id: 1, at: [-0.11, 0, 0], velocity: [0.2, 0, 0], angular_velocity: [0, 0, 10]}, {id: 2, at: "
                    "[0.11, 0, 0], velocity: [-0.2, 0, 0], angular_velocity: [0, 0, -10]}",
                    ball(s, "restitution: 0.5, friction: 0.4"), weightless),
            step);
  run_until(run, 0.2);
  return worst_of({(run.spin(1) - Vec3(0, 0, 10)).norm() / 10, std::abs(run.velocity(1).y())});
}

/// What two alike materials say; the one called rigid is a thousand times stiffer, if that counts.
std::string on_rigid(const Setting& s, const std::string& contact, double density, double young, double poisson) {
  const auto material = [&](const char* name, double stiffness) {
    return fmt::format("{}: {{density: {}, {}{}}}", name, density, contact, hertzian(s, stiffness, poisson));
  };
  return weightless + "materials: {" + material("ball", young) + ", " + material("rigid", 1000 * young) +
         "}\nboundaries: [{plane: {normal: [0, 0, 1]}, material: rigid}]\n";
}

constexpr double small = 1e-5, fast = 5, rough = 0.3;  // m, m/s, coefficient of friction

/// Test 5: a steel ball of 10 um comes down with 5 m/s and x mu times as much along the plane.
ElementState small_ball(const Setting& s, double x) {
  ModelRun run = trial(s,
                       on_rigid(s, fmt::format("friction: {}, restitution: 1", rough), 7850, 2.08e11, 0.3) +
                           fmt::format("elements:\n  - {{packing: list, material: ball, shape: {{sphere: {}}}, items: "
                                       "[{{id: 1, at: [0, 0, {:.17g}], velocity: [{:.17g}, 0, {}]}}]}}\n",
                                       small, 1.01 * small, x * rough * fast, -fast) +
                           "time: {dt: 1e-8, steps: 1}\n",
                       1e-8);
  run_until(run, 2e-7);
  return run.of(1);
}

/// R w' / (mu v_n)
double spun(const ElementState& e) { return small * e.twist.angular.y() / (rough * fast); }

double small_ball_slides(const Setting& s) {
  double most = 0;
  for (const double x : {8.0, 12.0, 20.0}) most = worst_of({most, std::abs(spun(small_ball(s, x)) / 5 - 1)});
  return most;
}

double small_ball_sticks(const Setting& s) {
  double most = 0;
  for (const double x : {1.0, 2.0, 4.0, 6.0}) {
    const ElementState e = small_ball(s, x);
    most = worst_of({most, std::abs(e.twist.linear.x() - small * e.twist.angular.y()) / (x * rough * fast)});
  }
  return most;
}

/// Finite elements, from the paper's graph.
constexpr Point finite_elements[] = {{0.595, 0.406}, {1.185, 0.982}, {1.896, 1.793}, {2.763, 2.856},
                                     {3.301, 3.441}, {4.688, 4.569}, {7.029, 4.941}};

/// Of the greatest.
double small_ball_swings_back(const Setting& s) {
  double most = 0;
  for (const Point& p : finite_elements) most = worst_of({most, std::abs(spun(small_ball(s, p.at)) - p.expected) / 5});
  return most;
}

/// Speed of a ball's surface against what it meets, before and after.
struct Slip {
  double before, after;
  /// As the paper counts it: more than 0 if the slip was turned round.
  double turned() const { return -after / before; }
};

constexpr double radius = 0.1, closing = 0.2;  // m, m/s

/// X = (7/2) mu (1 + e) v_n / (w R): below 1 it slides all the time.
double spin_for(double x) { return 3.5 * 0.4 * 1.5 * closing / (x * radius); }

/// Test 6: a spinning ball of aluminium alloy comes straight down.
Slip on_plane(const Setting& s, double x) {
  const double spin = spin_for(x);
  ModelRun run = trial(s,
                       on_rigid(s, "friction: 0.4, restitution: 0.5", 2700, 7e10, 0.33) +
                           fmt::format("elements:\n  - {{packing: list, material: ball, shape: {{sphere: {}}}, items: "
                                       "[{{id: 1, at: [0, 0, {}], velocity: [0, 0, {}], angular_velocity: [0, {:.17g}, "
                                       "0]}}]}}\ntime: {{dt: 1e-3, steps: 1}}\n",
                                       radius, 1.005 * radius, -closing, spin),
                       step);
  run_until(run, 0.015);
  return {-radius * spin, run.velocity(1).x() - radius * run.spin(1).y()};
}

/// Test 8: it meets a ball of five times the size and a thousand times the density.
Slip on_big_ball(const Setting& s, double x) {
  const double spin = spin_for(x), big = 5 * radius;
  ModelRun run = trial(
      s,
      weightless + "materials: {ball: {density: 2700, friction: 0.4, restitution: 0.5" + hertzian(s, 7e10, 0.33) +
          fmt::format("}}}}\nelements:\n  - {{packing: list, shape: {{sphere: {}}}, items: [{{id: 1, at: [{}, 0, 0], "
                      "velocity: [{}, 0, 0], angular_velocity: [0, 0, {:.17g}]}}, {{id: 2, at: [{}, 0, 0], shape: "
                      "{{sphere: {}}}, mass: {:.17g}}}]}}\ntime: {{dt: 1e-3, steps: 1}}\n",
                      radius, -1.005 * radius, closing, spin, big, big,
                      2.7e6 * 4 / 3 * std::numbers::pi * big * big * big),
      step);
  run_until(run, 0.015);
  return {radius * spin, run.velocity(1).y() + radius * run.spin(1).z() - run.velocity(2).y() + big * run.spin(2).z()};
}

using Meeting = Slip (*)(const Setting&, double);

/// Of the slip before.
template <Meeting meet>
double slides(const Setting& s) {
  double most = 0;
  for (const double x : {0.187, 0.358, 0.551, 0.765}) most = worst_of({most, std::abs(meet(s, x).turned() - (x - 1))});
  return most;
}

template <Meeting meet>
double sticks(const Setting& s) {
  double most = 0;
  for (const double x : {1.5, 3.0, 10.0}) most = worst_of({most, std::abs(meet(s, x).turned())});
  return most;
}

/// The paper's curve for aluminium alloy.
constexpr Point alloy[] = {{1.2139, 0.096}, {1.492, 0.111}, {2.5187, 0.006}, {4.508, -0.139}, {11.909, -0.259}};

double swings_back(const Setting& s) {
  double most = 0;
  for (const Point& p : alloy) most = worst_of({most, std::abs(on_plane(s, p.at).turned() - p.expected)});
  return most;
}

}  // namespace

std::vector<Case> chung_ooi() {
  return {
      {"T3 two balls, Hertz", "Chung & Ooi (2011) test 1, glass: force, overlap and time", two_balls, 0.005, 0.005,
       needs_springs},
      {"T3 ball on a plane, Hertz", "Chung & Ooi (2011) test 2, aluminium: force, overlap and time", ball_on_plane,
       0.005, 0.005, needs_springs},
      {"T3 ball on a plane, restitution", "Chung & Ooi (2011) test 3, e = 0.2 to 1", plane_returns, 0.02, 0.005},
      {"T3 glancing a plane, slides", "Chung & Ooi (2011) test 4, 40° to 80°: v_t'/v_t and spin", plane_slides, 0.05,
       0.005},
      {"T3 glancing a plane, micro-slip", "Chung & Ooi (2011) test 4, 10° to 30°: v_t'/v_t, the paper's curve",
       plane_swings_back, 0.05, 0.05, needs_springs},
      {"T3 glancing a plane, budgets", "the same, 10° to 80°: v_n'/v_n = 0.98, angular momentum about the contact",
       plane_budgets, 0.02, 0.002},
      {"T3 opposite spins", "Chung & Ooi (2011) test 7: spin stays", opposite_spins, 1e-3, 1e-9},
      {"T3 along a plane, slides", "Chung & Ooi test 5, v_t > 7 mu v_n: R w' = 5 mu v_n", small_ball_slides, 0.05,
       0.01},
      {"T3 along a plane, sticks", "Chung & Ooi test 5, v_t < 7 mu v_n, rigid: no slip is left", small_ball_sticks,
       0.05, 0.05, needs_impulses},
      {"T3 along a plane, micro-slip", "Chung & Ooi test 5, finite elements: R w', in 5 mu v_n", small_ball_swings_back,
       0.05, 0.05, needs_springs},
      {"T3 spin on a plane, slides", "Chung & Ooi test 6, X = 7/2 mu (1 + e) v_n / (w R) < 1: slip left 1 - X",
       slides<on_plane>, 0.05, 0.01},
      {"T3 spin on a plane, sticks", "Chung & Ooi test 6, X > 1, rigid: no slip is left", sticks<on_plane>, 0.05, 0.05,
       needs_impulses},
      {"T3 spin on a plane, micro-slip", "Chung & Ooi test 6, the paper's curve of the slip left, in slips before",
       swings_back, 0.05, 0.05, needs_springs},
      {"T3 spin on a big ball, slides", "Chung & Ooi test 8, 5 times as big: slip left 1 - X", slides<on_big_ball>,
       0.05, 0.01},
      {"T3 spin on a big ball, sticks", "Chung & Ooi test 8, X > 1, rigid: no slip is left", sticks<on_big_ball>, 0.05,
       0.05, needs_impulses},
  };
}

}  // namespace moraine::test
