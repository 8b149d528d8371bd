// SPDX-License-Identifier: Apache-2.0
// Convex hull of a set of points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "physics/types.hpp"

namespace moraine {

/// Corners in the order they were given, and outward-facing triangles over them.
struct HullMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The convex hull. Errors: InputError for fewer than 4 points, points that are not finite, or all in one plane.
/// Cost: n log n. Source: Quickhull (Barber, Dobkin & Huhdanpaa 1996), by the qhull library.
HullMesh convex_hull(const std::vector<Vec3>& points);

}  // namespace moraine
