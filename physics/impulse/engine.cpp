// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/engine.hpp"

#include <cmath>

#include "physics/impulse/world.hpp"
#include "physics/step_advice.hpp"

namespace moraine::impulse {
namespace {

bool supports(const Geometry& geometry) { return std::holds_alternative<Sphere>(geometry); }

/// A guess: flat while a world fits the processor's caches, then a little more; timings scattered by more than that.
double relative_cost(double bodies) { return 1 + 0.25 * std::log10(std::max(bodies, 1e4) / 1e4); }

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
          .coupling_leak = 0.98,
          .advised_step = impulse_step_advice};
}

}  // namespace moraine::impulse
