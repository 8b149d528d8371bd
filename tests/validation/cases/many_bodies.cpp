// SPDX-License-Identifier: Apache-2.0
// Many bodies, of which sums and means are known.
#include <cmath>
#include <map>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

/// Smooth spheres that come to rest in a smooth box.
const std::string box = R"(
gravity: [0, 0, -9.81]
materials: {ball: {density: 2500, friction: 0, restitution: 0}}
elements:
  - {packing: cubic, shape: {sphere: 0.01}, cells: [4, 4, 8], at: [0.001, 0.001, 0], spacing: 1.03, jitter: 0.01, seed: 3}
boundaries: [{box: [[0, 0, 0], [0.085, 0.085, 0.4]], open_top: true}]
time: {dt: 1 / 2000, steps: 1}
run: {iterations: 20}
)";

struct Resting {
  double force = 0, energy = 0, overlap = 0;  ///< of the floor, in weights; per body, in m g d; largest, in diameters
};

/// After 1.5 s, means over half a second.
Resting come_to_rest(const Setting& s) {
  ModelRun run = trial(s, box, 1.0 / 2000);
  run_until(run, 1.5);
  const auto n = static_cast<double>(run.scene().elements.size());
  const double weight = n * run.scene().typical_mass() * 9.81;
  Resting r;
  const int looks = 500;
  const std::int64_t between = std::max<std::int64_t>(1, std::lround(0.5 / looks / run.scene().time.dt));
  for (int k = 0; k < looks; ++k) {
    run.steps(between);
    r.force += run.boundary_impulse().z() / run.scene().time.substep() / weight / looks;
    r.energy += run.kinetic_energy() / (weight * run.scene().typical_diameter()) / looks;
  }
  r.overlap = run.model().overlaps().max;
  return r;
}

/// Three cases look at one run.
const Resting& rest_of(const Setting& s) {
  static std::map<std::pair<std::string, bool>, Resting> seen;
  const auto [at, fresh] = seen.try_emplace({s.engine, s.cut});
  if (fresh) at->second = come_to_rest(s);
  return at->second;
}

double floor_force(const Setting& s) { return std::abs(rest_of(s).force - 1); }
double rest_energy(const Setting& s) { return rest_of(s).energy; }
double rest_overlap(const Setting& s) { return rest_of(s).overlap; }

/// Two blocks of 27 spheres fly into each other; `drift` moves both.
ModelRun clusters(const Setting& s, const std::string& drift) {
  return trial(
      s,
      weightless + "parameters: {v: 1}\nmaterials: {ball: {density: 1000, friction: 0.3, restitution: 0.5" +
          std::string(s.springs() ? ", normal_stiffness: 1e5" : "") +
          "}}\nelements:\n"
          "  - {packing: cubic, shape: {sphere: 0.05}, cells: [3, 3, 3], at: [-0.35, 0, 0], spacing: 1.01, jitter: "
          "0.004, "
          "seed: 1, velocity: [1 + " +
          drift +
          "]}\n"
          "  - {packing: cubic, shape: {sphere: 0.05}, cells: [3, 3, 3], at: [0.05, 0.02, 0.01], spacing: 1.01, "
          "jitter: "
          "0.004, seed: 2, velocity: [-1 + " +
          drift + "]}\ntime: {dt: 1e-3, steps: 1}\n",
      1e-3);
}

double clusters_momentum(const Setting& s) {
  ModelRun run = clusters(s, "0, 0, 0");
  run_until(run, 0.3);
  Vec3 sum = Vec3::Zero();
  double all = 0;
  for (const ElementState& e : run.model().states()) sum += e.twist.linear, all += 1;
  return sum.norm() / all;
}

/// The same with 10, -7 and 3 m/s more, seen from there after 40 ms. In diameters.
double galilean(const Setting& s) {
  ModelRun here = clusters(s, "0, 0, 0"), there = clusters(s, "10, -7, 3");
  run_until(here, 0.04);
  run_until(there, 0.04);
  const std::vector<ElementState> a = here.model().states(), b = there.model().states();
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = worst_of({most, (b[i].pose.position - a[i].pose.position - there.time() * Vec3(10, -7, 3)).norm() / 0.1});
  return most;
}

}  // namespace

std::vector<Case> many_bodies() {
  return {
      {"C1 box, floor force", "128 smooth spheres: the floor carries their weight", floor_force, 0.01, 0.001},
      {"C1 box, motion", "kinetic energy per sphere at rest, in m g d", rest_energy, 1e-3, 1e-6},
      {"C1 box, overlap", "largest, in diameters", rest_overlap, 0.01, 0.01},
      {"P1 clusters, momentum", "2 x 27 spheres collide; per sphere and speed of 1 m/s", clusters_momentum, 1e-6,
       1e-12},
      {"P6 Galilean", "the same with 12.6 m/s more, in diameters after 40 ms", galilean, 1e-4, 1e-9},
  };
}

}  // namespace moraine::test
