// SPDX-License-Identifier: Apache-2.0
// Which elements are tied together.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "physics/scene/scene.hpp"

namespace moraine {

/// Pairs of spheres whose gap is at most `tolerance` times the sum of their radii, as ids a < b, ascending.
/// Other shapes are left out. Cost: linear in elements while radii are alike.
std::vector<std::pair<ElementId, ElementId>> touching_pairs(const Scene& scene, double tolerance);

/// How long a bond may become before it breaks, in rest lengths: normally distributed, but never below
/// 1 + (mean - 1) / 10, and for each pair the same whatever other bonds there are.
struct BreakLength {
  double mean = std::numeric_limits<double>::infinity();
  double spread = 0;  ///< standard deviation
  std::uint64_t seed = 1;

  double of(ElementId a, ElementId b) const;
};

/// The element with this id, or nullptr. Elements ascend by id. Cost: log n.
const Element* find_element(std::span<const Element> elements, ElementId id);

}  // namespace moraine
