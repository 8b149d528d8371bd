// SPDX-License-Identifier: Apache-2.0
// The pieces that boundaries are made of, and where a ball touches them.
#pragma once

#include <variant>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/types.hpp"

namespace moraine::native {

struct HalfSpace {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit, out of the solid
};
struct Block {
  Pose pose;
  Vec3 half_extents = Vec3::Zero();
};
/// Everything within `radius` of a line; a sphere if both ends are the same.
struct Rod {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  double radius = 0;
};
/// Solid from both sides.
struct Triangle {
  std::array<Vec3, 3> corners;
};

using Surface = std::variant<HalfSpace, Block, Rod, Triangle>;

/// Where a surface is nearest to a point.
struct Nearest {
  Vec3 point = Vec3::Zero();    ///< on the surface
  Vec3 normal = Vec3::UnitZ();  ///< unit, from the surface towards where the ball belongs
  double distance = 0;          ///< of the centre along the normal [m]; negative inside a solid
};

/// Ties are decided the same way always. Source for triangles: Ericson, Real-Time Collision Detection (2005), 5.1.5.
Nearest nearest(const Surface& surface, const Vec3& centre);

/// Box around a surface; infinite for half spaces.
Bounds bounds(const Surface& surface);

/// The surfaces of a boundary whose frame is at `pose`. Hulls become their triangles, compounds the surfaces of their
/// parts.
std::vector<Surface> surfaces(const Boundary& boundary, const Scene& scene, const Pose& pose);

}  // namespace moraine::native
