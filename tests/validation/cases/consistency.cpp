// SPDX-License-Identifier: Apache-2.0
// What must hold for any scene: loads pass through cuts, nothing is lost at them, and neither a mirror nor other
// numbers change the motion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

constexpr double g = 9.81, step = 1e-3;
constexpr int tall = 20;

/// Spheres of 1 m and 1 kg, one on the other, cut at half the height.
ModelRun column(const Setting& s) {
  return trial(s,
               fmt::format("materials: {{ball: {{density: 1, {}}}}}\nelements: [{{packing: cubic, shape: {{sphere: "
                           "0.5}}, mass: 1, cells: [1, 1, {}], at: [-0.5, -0.5, 0]}}]\nrun: {{sub_models: 2}}\ntime: "
                           "{{dt: 1e-3, steps: 1}}\n",
                           ball(s, "restitution: 0"), tall) +
                   floor_at_zero,
               step);
}

/// Of the two spheres at the cut, in diameters; on springs against that of ten weights.
double column_sinks(const Setting& s) {
  ModelRun run = column(s);
  run_until(run, 2);
  const double overlap = 1 - (run.position(tall / 2) - run.position(tall / 2 - 1)).norm();
  return s.springs() ? std::abs(overlap / (tall / 2 * g / 1e6) - 1) : std::abs(overlap);
}

/// Most that there ever is above what there was, per sphere, in m g d.
double column_gains(const Setting& s) {
  ModelRun run = column(s);
  const auto energy = [&] { return run.model().statistics().ledger.energy() / (tall * g); };
  const double before = energy();
  double most = before;
  while (run.time() < 1) {
    run.steps(5);
    most = worst_of({most, energy()});
  }
  return most - before;
}

/// Three bonded spheres in a row turn about the middle one in 0.4 s, past others that stand left and right. Two
/// sub-models, cut anew as soon as those have become each other's ghosts.
std::string rotor() {
  std::string items;
  const double speed = 0.5 * 2 * std::numbers::pi / 0.4;
  for (const double degrees : {-60, -20, 20, 60, 120, 160, 200, 240}) {
    const double angle = degrees * std::numbers::pi / 180;
    items += fmt::format(", {{at: [{:.17g}, {:.17g}, 0]}}", 0.75 * std::cos(angle), 0.75 * std::sin(angle));
  }
  return weightless +
         fmt::format(
             "materials: {{ball: {{density: 1000, normal_stiffness: 1}}}}\nelements:\n  - {{packing: list, shape: "
             "{{sphere: 0.1}}, mass: 1, "
             "items: [{{id: 0, at: [0, 0, 0]}}, {{id: 1, at: [-0.5, 0, 0], velocity: [0, {0:.17g}, 0]}}, {{id: 2, at: "
             "[0.5, 0, 0], velocity: [0, -{0:.17g}, 0]}}{1}, {{at: [-1.5, 0, 0]}}, {{at: [1.5, 0, 0]}}]}}\nbonds: "
             "[{{a: 0, b: 1, stiffness: 1e4, damping: 20}}, {{a: 0, b: 2, stiffness: 1e4, damping: 20}}]\nrun: "
             "{{sub_models: 2, recut_ghost_share: 0.1, skin: 0.5}}\ntime: {{dt: 1e-3, steps: 1}}\n",
             speed, items);
}

/// Elements that are not in exactly one sub-model, and bonds that are gone.
double lost(const ModelRun& run) {
  std::vector<int> times(run.scene().elements.size(), 0);
  for (std::size_t p = 0; p < run.model().size(); ++p)
    for (const std::uint32_t e : run.model().part(p).members()) ++times[e];
  const auto elements = std::count_if(times.begin(), times.end(), [](int n) { return n != 1; });
  return static_cast<double>(elements) + 2 - static_cast<double>(run.model().alive_bonds().size());
}

/// After the outer two have gone from one side to the other, and where there is a cut from one sub-model to the other,
/// two hundred times.
double identity(const Setting& s) {
  ModelRun run = trial(s, rotor(), step);
  constexpr int enough = 200;
  int crossings = 0, handed = 0;
  double most = 0;
  bool left = true;
  std::vector<SubModelId> owners = run.model().owners();
  while ((crossings < enough || (s.cut && handed < enough)) && run.time() < 60) {
    run_until(run, run.time() + 0.02);
    if (left != (run.position(1).x() < 0)) crossings += 2, left = !left;
    for (const std::size_t i : {1U, 2U}) handed += run.model().owners()[i] != owners[i];
    owners = run.model().owners();
    most = worst_of({most, lost(run)});
  }
  return most + std::max(0, enough - crossings) + (s.cut ? std::max(0, enough - handed) : 0);
}

struct Body {
  Vec3 at, velocity, spin;
  double mass;
};

/// Two meet obliquely, a third of a step after the twentieth, both with spin.
std::vector<Body> meeting() {
  const Vec3 v(1, 0.9, 0.1);
  const double time = 0.0203;
  return {{Vec3(-0.1, 0, 0) - time * v, v, {3, -2, 5}, 1}, {Vec3(0.1, 0, 0) + time * v, -v, {1, 4, -2}, 2}};
}

/// Three bonded to each other, that swing and turn.
std::vector<Body> swinging() {
  return {{{-0.5, 0, 0}, {-0.3, 0.2, 0.1}, {0, 0, 0}, 1},
          {{0.5, 0.1, 0}, {0.2, 0.1, -0.2}, {0, 0, 0}, 2},
          {{0.1, 0.9, 0.2}, {0.1, -0.2, 0.2}, {0, 0, 0}, 1.5}};
}

/// Where they are and go after 0.1 s. `id`: of a body by its place in the list.
template <class Id>
std::vector<Body> after(const Setting& s, const std::vector<Body>& bodies, bool bonded, const Id& id) {
  const auto list = [](const Vec3& v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z()); };
  std::string items, bonds;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& b = bodies[i];
    items += fmt::format("{{id: {}, at: {}, velocity: {}, angular_velocity: {}, mass: {}}}, ", id(i), list(b.at),
                         list(b.velocity), list(b.spin), b.mass);
    for (std::size_t k = 0; bonded && k < i; ++k)
      bonds += fmt::format("{{a: {}, b: {}, stiffness: 1000}}, ", id(k), id(i));
  }
  ModelRun run = trial(s,
                       spheres(items, ball(s, "restitution: 0.8, friction: 0.1"),
                               weightless + (bonded ? "bonds: [" + bonds + "]\n" : "")),
                       step);
  run_until(run, 0.1);
  std::vector<Body> out;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const ElementState e = run.of(static_cast<ElementId>(id(i)));
    out.push_back({e.pose.position, e.twist.linear, e.twist.angular, bodies[i].mass});
  }
  return out;
}

/// The largest difference in place [m], speed [m/s] and speed of the surface [m/s].
double apart(const std::vector<Body>& a, const std::vector<Body>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = worst_of({most, (a[i].at - b[i].at).norm(), (a[i].velocity - b[i].velocity).norm(),
                     0.1 * (a[i].spin - b[i].spin).norm()});
  return most;
}

std::size_t as_listed(std::size_t i) { return i; }

/// In a plane across an axis; spins are turned round about the other two.
std::vector<Body> mirrored(std::vector<Body> bodies, Eigen::Index axis) {
  for (Body& b : bodies) {
    b.at[axis] *= -1;
    b.velocity[axis] *= -1;
    b.spin *= -1;
    b.spin[axis] *= -1;
  }
  return bodies;
}

double mirror_differs(const Setting& s) {
  double most = 0;
  for (const bool bonded : {false, true}) {
    const std::vector<Body> start = bonded ? swinging() : meeting(), end = after(s, start, bonded, as_listed);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      most = worst_of({most, apart(mirrored(end, axis), after(s, mirrored(start, axis), bonded, as_listed))});
  }
  return most;
}

/// Numbered the other way round.
double numbers_differ(const Setting& s) {
  double most = 0;
  for (const bool bonded : {false, true}) {
    const std::vector<Body> start = bonded ? swinging() : meeting();
    const auto backwards = [&](std::size_t i) { return start.size() - i; };
    most = worst_of({most, apart(after(s, start, bonded, as_listed), after(s, start, bonded, backwards))});
  }
  return most;
}

}  // namespace

std::vector<Case> consistency() {
  return {
      {"P4 column, sink",
       "20 spheres: overlap at the cut, in d: at most 10 (1 - f) g dt^2 / (recovery d) at f = 0.85 "
       "(springs: weight / stiffness)",
       column_sinks, 1.5e-4, 0.01},
      {"P4 column, energy", "20 spheres: never more than before, per sphere in m g d", column_gains, 1e-6, 1e-6},
      {"P5 identity", "bonded row of three, 200 crossings of a cut: elements and bonds lost", identity, 0, 0,
       needs_bonds},
      {"P7 mirror", "an oblique impact, three bonded: mirrored motion [m, m/s]; cut, impulses are as exact as in T2",
       mirror_differs, 0.02, 1e-9, needs_bonds},
      {"P8 numbers", "the same, numbered backwards: same motion [m, m/s]", numbers_differ, 1e-6, 1e-9, needs_bonds},
  };
}

}  // namespace moraine::test
