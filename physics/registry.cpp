// SPDX-License-Identifier: Apache-2.0
// The table of engines.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/bullet/engine.hpp"
#include "physics/errors.hpp"
#include "physics/impulse/engine.hpp"
#include "physics/ode/engine.hpp"
#include "physics/soft_sphere/engine.hpp"
#include "physics/world.hpp"

namespace moraine {

std::span<const Engine> engines() {
  static const std::array table{bullet::float32_engine(), bullet::float64_engine(), impulse::engine(),
                                soft_sphere::engine(), ode::engine()};
  return table;
}

const Engine& find_engine(std::string_view name) {
  for (const Engine& e : engines())
    if (e.name == name) return e;
  std::string known = "\n  auto         impulse for scenes of spheres, bullet otherwise";
  for (const Engine& e : engines()) known += fmt::format("\n  {:<12} {}", e.name, e.help);
  throw InputError(fmt::format("unknown engine '{}', expected one of:{}", name, known));
}

const Engine& find_engine(std::string_view name, const Scene& scene) {
  if (name != "auto") return find_engine(name);
  const Engine& fastest = find_engine("impulse");
  const bool fits = std::all_of(scene.elements.begin(), scene.elements.end(),
                                [&](const Element& e) { return fastest.supports(scene.shape_of(e).geometry); });
  return fits ? fastest : find_engine("bullet");
}

}  // namespace moraine
