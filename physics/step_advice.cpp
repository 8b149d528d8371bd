// SPDX-License-Identifier: Apache-2.0
#include "physics/step_advice.hpp"

#include <fmt/format.h>

#include <cmath>

#include "physics/scene/bonds.hpp"

namespace moraine {
namespace {

constexpr double share_of_fall = 1.0 / 20, share_of_swing = 0.5;

}  // namespace

StepLimit impulse_step_advice(const Scene& scene) {
  StepLimit advice;
  const auto tighten = [&](double substep, const auto& reason) {
    if (substep < advice.substep) advice = {substep, reason()};
  };
  const double g = scene.gravity.norm();
  for (const Element& e : scene.elements)
    if (g > 0)
      tighten(share_of_fall * std::sqrt(2 * scene.shape_of(e).bounding_radius / g),
              [&] { return fmt::format("the fall of element {}, sqrt(d / g) / 20", e.id); });
  for (const Bond& b : scene.bonds) {
    const double a = find_element(scene.elements, b.a)->mass, c = find_element(scene.elements, b.b)->mass;
    tighten(share_of_swing * std::sqrt(a * c / (a + c) / b.stiffness),
            [&] { return fmt::format("the bond of elements {} and {}, sqrt(m* / k) / 2", b.a, b.b); });
  }
  return advice;
}

}  // namespace moraine
