// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/engine.hpp"

#include <algorithm>
#include <cmath>

#include "physics/impulse/world.hpp"
#include "physics/step_advice.hpp"

namespace moraine::impulse {
namespace {

bool supports(const Geometry& geometry) { return std::holds_alternative<Sphere>(geometry); }

/// Shape of the measured curve of cost per body against bodies per world; see docs/engines.md. Small worlds have more
/// to tell than to compute, large ones leave the processor's caches.
double relative_cost(double bodies) {
  const double decades = std::log10(std::max(bodies, 1.0) / 1e4);
  return 1 + 0.2 * std::clamp(decades, 0.0, 1.0) + 0.09 * std::max(decades - 1, 0.0) +
         0.16 * std::max(-decades - 0.3, 0.0);
}

std::unique_ptr<World> make(const WorldSettings& settings, const Vec3& origin) {
  return std::make_unique<ImpulseWorld>(settings, origin);
}

}  // namespace

Engine engine() {
  return {.name = "impulse",
          .help = "sequential impulses for spheres, float32: large steps, friction, bonds; fastest",
          .precision = "float32",
          .supports = supports,
          .relative_cost = relative_cost,
          .make = make,
          .coupling_leak = 0.995,
          .advised_step = impulse_step_advice};
}

}  // namespace moraine::impulse
