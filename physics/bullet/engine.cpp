// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/engine.hpp"

#include <cmath>

#include "physics/bullet/world.hpp"
#include "physics/step_advice.hpp"

namespace moraine::bullet {
namespace {

bool supports(const Geometry&) { return true; }

/// Shape of the measured curve of cost per element-step against elements per world; see docs/accuracy.md.
double relative_cost(double bodies) { return 1 + 0.42 * std::log10(std::max(bodies, 500.0) / 500); }

std::unique_ptr<World> make(const WorldSettings& settings, const Vec3& origin) {
  return std::make_unique<BulletWorld>(settings, origin);
}

}  // namespace

Engine engine() {
  return {.name = "bullet",
          .help = "Bullet 3.24, float32: spheres, boxes, capsules, hulls, compounds; friction, bonds",
          .precision = "float32",
          .supports = supports,
          .relative_cost = relative_cost,
          .make = make,
          .advised_step = impulse_step_advice};
}

}  // namespace moraine::bullet
