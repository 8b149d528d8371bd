// SPDX-License-Identifier: Apache-2.0
// One body: flight, bounce, slope, spin. Where the case is cut, three of them side by side do the same, close enough to
// be each other's ghosts.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

constexpr double g = 9.81, slope = std::numbers::pi / 6;
constexpr double step = 1e-3;  // s

/// One item, or three beside each other along y. `width`: of a body [m].
std::string side_by_side(const Setting& s, const std::string& item, double z, double width) {
  std::string items;
  for (int i = 0; i < (s.cut ? 3 : 1); ++i)
    items += fmt::format("{}{{id: {}, at: [0, {}, {:.17g}]{}}}", i > 0 ? ", " : "", i + 1, 1.02 * width * i, z, item);
  return items;
}

/// The worst of all bodies.
template <class Error>
double worst(const ModelRun& run, const Error& error) {
  double most = 0;
  for (const ElementState& s : run.model().states()) most = worst_of({most, std::abs(error(s))});
  return most;
}

/// In units of the error that the step explains: symplectic Euler falls g t dt / 2 too far, Verlet does not.
double projectile(const Setting& s) {
  ModelRun run =
      trial(s, spheres(side_by_side(s, ", velocity: [3, 0, 4]", 100, 0.2), ball(s, "friction: 0"), ""), step);
  run_until(run, 1);
  const double t = run.time(), of_step = 0.5 * g * t * run.scene().time.dt;
  const double expected = 100 + 4 * t - 0.5 * g * t * t - (s.springs() ? 0 : of_step);
  return worst(run, [&](const ElementState& e) { return (e.pose.position.z() - expected) / (0.5 * g * step); });
}

/// Falls from `height` at one of five phases of the step; e is the root of the energy after by that before.
double rebound_error(const Setting& s, double e, double height) {
  double most = 0;
  const double speed = std::sqrt(2 * g * height), dt = std::min(step, 1e-3 * speed);
  for (int phase = 0; phase < 5; ++phase) {
    const double from = height + speed * dt * phase / 5;
    ModelRun run = trial(
        s, spheres(side_by_side(s, "", 0.1 + from, 0.2), ball(s, fmt::format("restitution: {}", e)), floor_at_zero), dt,
        {}, 0.02);
    run_until(run, (1 + 0.5 * e) * std::sqrt(2 * from / g));
    const double error = worst(run, [&](const ElementState& state) {
      const double energy = g * (state.pose.position.z() - 0.1) + 0.5 * state.twist.linear.z() * state.twist.linear.z();
      return std::sqrt(std::max(0.0, energy) / (g * from)) - e;
    });
    most = worst_of({most, error});
  }
  return most;
}

double bounce(const Setting& s) {
  double most = 0;
  for (const double e : {0.3, 0.5, 0.8, 1.0}) most = worst_of({most, rebound_error(s, e, 1)});
  return most;
}

double small_bounce(const Setting& s) { return rebound_error(s, 0.5, 1e-3); }

/// Gravity is turned instead of the floor: down the slope towards `heading`.
Override on_slope(double heading) {
  return set("gravity", fmt::format("[{:.17g}, {:.17g}, {:.17g}]", g * std::sin(slope) * std::cos(heading),
                                    g * std::sin(slope) * std::sin(heading), -g * std::cos(slope)));
}

std::string blocks(const Setting& s, double friction) {
  return fmt::format(
             "materials: {{wood: {{density: 250, friction: {}}}}}\nelements:\n  - {{packing: list, shape: {{box: [0.2, "
             "0.2, 0.1]}}, mass: 1, items: [{}]}}\ntime: {{dt: 1e-3, steps: 1}}\n",
             friction, side_by_side(s, "", 0.05, 0.2)) +
         floor_at_zero;
}

/// Mean acceleration between 0.2 and 0.7 s, of the body that is furthest from `expected`, relative to that.
double acceleration_error(ModelRun& run, double expected) {
  run_until(run, 0.2);
  const double begin = run.time();
  std::vector<double> early;
  for (const ElementState& e : run.model().states()) early.push_back(e.twist.linear.head<2>().norm());
  run_until(run, 0.7);
  std::size_t i = 0;
  return worst(run, [&](const ElementState& e) {
    return (e.twist.linear.head<2>().norm() - early[i++]) / (run.time() - begin) / expected - 1;
  });
}

double block_slides(const Setting& s) {
  double most = 0;
  for (const double heading : {0.0, std::numbers::pi / 4}) {
    ModelRun run = trial(s, blocks(s, 0.3), step, {on_slope(heading)});
    most = worst_of({most, acceleration_error(run, g * (std::sin(slope) - 0.3 * std::cos(slope)))});
  }
  return most;
}

bool slides(const Setting& s, double friction, double heading) {
  ModelRun run = trial(s, blocks(s, friction), step, {on_slope(heading)});
  run_until(run, 1);
  return worst(run, [](const ElementState& e) { return e.twist.linear.norm(); }) > 1e-2;
}

/// The coefficient of friction from which it sticks, by bisection, against the slope's tangent.
double block_sticks(const Setting& s) {
  double most = 0;
  for (const double heading : {0.0, std::numbers::pi / 4}) {
    double low = 0.4, high = 0.8;
    for (int i = 0; i < 8; ++i) (slides(s, (low + high) / 2, heading) ? low : high) = (low + high) / 2;
    most = worst_of({most, std::abs((low + high) / 2 / std::tan(slope) - 1)});
  }
  return most;
}

std::string balls_on_floor(const Setting& s, double friction, const std::string& more = "") {
  return spheres(side_by_side(s, more, 0.1, 0.2), ball(s, fmt::format("friction: {}", friction)), floor_at_zero);
}

double ball_rolls(const Setting& s) {
  ModelRun run = trial(s, balls_on_floor(s, 0.5), step, {on_slope(0)});
  return acceleration_error(run, 5.0 / 7 * g * std::sin(slope));
}

double ball_slides(const Setting& s) {
  ModelRun run = trial(s, balls_on_floor(s, 0.1), step, {on_slope(0)});
  return acceleration_error(run, g * (std::sin(slope) - 0.1 * std::cos(slope)));
}

double slide_to_roll(const Setting& s) {
  double most = 0;
  for (const double friction : {0.1, 0.3}) {
    ModelRun run = trial(s, balls_on_floor(s, friction, ", velocity: [1, 0, 0]"), step);
    run_until(run, 1.5 * 2 / (7 * friction * g));
    most = worst_of({most, worst(run, [](const ElementState& e) { return e.twist.linear.x() / (5.0 / 7) - 1; })});
  }
  return most;
}

/// The weight's torque mu_r R m g is taken up by friction.
double rolling_decays(const Setting& s) {
  const double resistance = 0.1;
  ModelRun run = trial(s,
                       spheres(side_by_side(s, ", velocity: [1, 0, 0], angular_velocity: [0, 10, 0]", 0.1, 0.2),
                               ball(s, fmt::format("friction: 0.5, rolling_friction: {}", resistance)), floor_at_zero),
                       step);
  return acceleration_error(run, -5.0 / 7 * resistance * g);
}

double spin(const Setting& s) {
  ModelRun run = trial(
      s, spheres(side_by_side(s, ", angular_velocity: [60, 0, 80]", 0, 0.2), ball(s, "friction: 0.5"), weightless),
      step);
  run_until(run, 10);
  return worst(run, [](const ElementState& e) { return (e.twist.angular - Vec3(60, 0, 80)).norm() / 100; });
}

/// A box of 1 : 1 : sqrt(3), half as inert about its axis as across it. Energy and angular momentum after ten turns.
double top(const Setting& s) {
  const double a = 0.1, c = a * std::sqrt(3), tilt = 10 * std::numbers::pi / 180;
  const std::string text =
      fmt::format(
          "materials: {{wood: {{density: 500}}}}\nelements:\n  - {{packing: list, shape: {{box: [{0}, {0}, "
          "{1:.17g}]}}, mass: 1, "
          "items: [{2}]}}\ntime: {{dt: 1e-3, steps: 1}}\n",
          a, c,
          side_by_side(
              s, fmt::format(", angular_velocity: [{:.17g}, 0, {:.17g}]", 20 * std::sin(tilt), 20 * std::cos(tilt)), 0,
              0.2)) +
      weightless;
  const Vec3 inertia((a * a + c * c) / 12, (a * a + c * c) / 12, a * a / 6);
  const auto momentum = [&](const ElementState& e) {
    const Vec3 own = e.pose.orientation.conjugate() * e.twist.angular;
    return Vec3(e.pose.orientation * inertia.cwiseProduct(own));
  };
  ModelRun run = trial(s, text, step);
  const ElementState first = run.model().states().front();
  const double energy = first.twist.angular.dot(momentum(first));
  run_until(run, 10 * 2 * std::numbers::pi / 20);
  return worst(run, [&](const ElementState& e) {
    return worst_of({(momentum(e) - momentum(first)).norm() / momentum(first).norm(),
                     std::abs(e.twist.angular.dot(momentum(e)) / energy - 1)});
  });
}

}  // namespace

std::vector<Case> one_body() {
  return {
      {"S1 projectile", "place after 1 s; in units of g t dt / 2, by which symplectic Euler falls too far", projectile,
       0.01, 1e-6},
      {"S2 bounce", "e = 0.3, 0.5, 0.8, 1 from 1 m", bounce, 0.02, 0.005},
      {"S2 small bounce", "e = 0.5 from 1 mm", small_bounce, 0.02, 0.005},
      {"S3 block slides", "a = g (sin 30° - 0.3 cos 30°), heading 0° and 45°", block_slides, 0.02, 0.02, needs_boxes},
      {"S3 block sticks", "from mu = tan 30° on, heading 0° and 45°", block_sticks, 0.02, 0.02, needs_boxes},
      {"S4 ball rolls", "a = 5/7 g sin 30°", ball_rolls, 0.02, 0.01},
      {"S4 ball slides", "a = g (sin 30° - 0.1 cos 30°)", ball_slides, 0.02, 0.01},
      {"S5 sliding to rolling", "v = 5/7 v0", slide_to_roll, 0.01, 0.01},
      {"S6 spin", "of a sphere, 10 s alone", spin, 1e-5, 1e-9},
      {"S6 rolling decay", "rolling friction mu_r = 0.1: a = -5/7 mu_r g", rolling_decays, 0.02, 0.02, needs_springs},
      {"S6 top", "momentum and energy after 10 turns, tilted by 10°", top, 0.01, 0.01, needs_boxes},
  };
}

}  // namespace moraine::test
