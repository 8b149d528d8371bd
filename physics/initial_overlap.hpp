// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "physics/scene/scene.hpp"

namespace moraine {

/// How deep a sphere is in another, or in a boundary, at the start.
struct InitialOverlap {
  double depth = 0;  ///< [diameters of the smaller sphere]
  ElementId element = 0;
  ElementId other = 0;  ///< or the boundary's number
  bool with_boundary = false;
};

/// The deepest of all; shapes other than spheres are not looked at. Cost: linear in elements.
InitialOverlap deepest_overlap(const Scene& scene);

}  // namespace moraine
