// SPDX-License-Identifier: Apache-2.0
#include "physics/ode/engine.hpp"

#include <algorithm>

#include "physics/plugin.hpp"
#include "physics/step_advice.hpp"

namespace moraine::ode {
namespace {

/// ODE has no collider for a hull against a triangle mesh and would let it fall
/// through without a word.
bool no_hull(const Primitive& p) { return !std::holds_alternative<ConvexHull>(p); }

bool supports(const Geometry& geometry) {
  if (const auto* compound = std::get_if<Compound>(&geometry))
    return std::all_of(compound->parts.begin(), compound->parts.end(), [](auto& p) { return no_hull(p.primitive); });
  return !std::holds_alternative<ConvexHull>(geometry);
}

/// A guess: its solver treats every island of touching bodies on its own and
/// does not know the others.
double relative_cost(double) { return 1; }

std::unique_ptr<World> make(const WorldSettings& settings, const Vec3& origin) {
  static const MakeWorld make = load_plugin("ode");
  return make(settings, origin);
}

}  // namespace

Engine engine() {
  return {.name = "ode",
          .help = "ODE 0.16 QuickStep, float64: spheres, boxes, capsules, compounds of them; friction, bonds",
          .precision = "float64",
          .supports = supports,
          .relative_cost = relative_cost,
          .make = make,
          .advised_step = impulse_step_advice};
}

}  // namespace moraine::ode
