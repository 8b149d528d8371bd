// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/engine.hpp"

#include "physics/soft_sphere/start_limit.hpp"
#include "physics/soft_sphere/step_limit.hpp"
#include "physics/soft_sphere/world.hpp"

namespace moraine::soft_sphere {
namespace {

bool supports(const Geometry& geometry) { return std::holds_alternative<Sphere>(geometry); }

/// Shape of the measured curve: flat from 1,000 to 30,000 elements, 13 % more at 100,000.
double relative_cost(double bodies) { return 1 + 0.25 * std::log10(std::max(bodies, 3e4) / 3e4); }

std::unique_ptr<World> make(const WorldSettings& settings, const Vec3&) {
  return std::make_unique<SoftSphereWorld>(settings);
}

}  // namespace

Engine engine() {
  return {.name = "soft_sphere",
          .help = "explicit DEM of spheres, float64: springs, dashpots, friction, rolling friction, bonds",
          .precision = "float64",
          .supports = supports,
          .relative_cost = relative_cost,
          .make = make,
          .ghosts = GhostKind::follower,
          .force_time = 0.5,
          .check = check_start,
          .step_limit = step_limit};
}

}  // namespace moraine::soft_sphere
