// SPDX-License-Identifier: Apache-2.0
// The lines that stand for boundaries in a picture.
#pragma once

#include <utility>
#include <vector>

#include "output/frame.hpp"

namespace moraine {

using Edge = std::pair<Vec3, Vec3>;

/// The twelve edges of a box.
std::vector<Edge> box_edges(const Bounds& box);

/// Edges of meshes and solids where the surface ends or bends by more than 20 degrees, circles of round solids, at the
/// frame's time; in the world. Planes have none.
std::vector<Edge> boundary_edges(const Scene& scene, const Frame& frame);

}  // namespace moraine
