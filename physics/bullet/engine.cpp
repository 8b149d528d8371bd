// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/engine.hpp"

#include <cmath>

#include "physics/plugin.hpp"
#include "physics/step_advice.hpp"

namespace moraine::bullet {
namespace {

bool supports(const Geometry&) { return true; }

/// Shape of the measured curve of cost per element-step against elements per world; see docs/accuracy.md.
double relative_cost(double bodies) { return 1 + 0.42 * std::log10(std::max(bodies, 500.0) / 500); }

// Debian's builds of Bullet in float32 and float64 have the same symbol names, so each is behind a library of its own.
std::unique_ptr<World> make_float32(const WorldSettings& settings, const Vec3& origin) {
  static const MakeWorld make = load_plugin("bullet");
  return make(settings, origin);
}

std::unique_ptr<World> make_float64(const WorldSettings& settings, const Vec3& origin) {
  static const MakeWorld make = load_plugin("bullet64");
  return make(settings, origin);
}

}  // namespace

Engine float32_engine() {
  return {.name = "bullet",
          .help = "Bullet 3.24, float32: spheres, boxes, capsules, hulls, compounds; friction, bonds",
          .precision = "float32",
          .supports = supports,
          .relative_cost = relative_cost,
          .make = make_float32,
          .advised_step = impulse_step_advice};
}

Engine float64_engine() {
  return {.name = "bullet64",
          .help = "the same in float64: twice the memory, for what float32 cannot resolve",
          .precision = "float64",
          .supports = supports,
          .relative_cost = relative_cost,
          .make = make_float64,
          .advised_step = impulse_step_advice};
}

}  // namespace moraine::bullet
