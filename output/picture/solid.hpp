// SPDX-License-Identifier: Apache-2.0
// Where a ray meets the solids elements are made of.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "physics/shape.hpp"

namespace moraine {

struct Hit {
  double distance = 0;  ///< along the ray, in lengths of its direction
  Vec3 normal = Vec3::Zero();
};

struct Ball {
  Vec3 centre;
  double radius;
};
struct Rod {
  Vec3 a, b;  ///< ends of the axis, where the round caps begin
  double radius;
};
/// The points with normal . p <= offset for every plane.
struct Polytope {
  struct Face {
    Vec3 normal;
    double offset;
  };
  std::vector<Face> faces;
};
using SolidPart = std::variant<Ball, Rod, Polytope>;

/// A geometry as parts in the shape's frame. Cost: n log n in the vertices of hulls.
std::vector<SolidPart> solid_parts(const Geometry& geometry);

/// The nearest entry of the ray into any part; the ray starts outside. `direction` has length one.
std::optional<Hit> hit(const std::vector<SolidPart>& parts, const Vec3& origin, const Vec3& direction);

}  // namespace moraine
