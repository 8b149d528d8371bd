// SPDX-License-Identifier: Apache-2.0
// The solids an element can be made of, in a frame whose origin is the centre of mass and whose axes are principal.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "physics/types.hpp"

namespace moraine {

struct Sphere {
  double radius = 0;  ///< [m]
};
struct Cuboid {
  Vec3 half_extents = Vec3::Zero();  ///< [m]
};
/// Axis along z; the length without the two caps is 2 half_length.
struct Capsule {
  double radius = 0;
  double half_length = 0;
};
struct ConvexHull {
  std::vector<Vec3> vertices;  ///< corners of the hull only
};

using Primitive = std::variant<Sphere, Cuboid, Capsule, ConvexHull>;

/// Primitives rigidly joined; overlapping volume counts twice, as usual for clumps of this kind.
struct Compound {
  struct Part {
    Primitive primitive;
    Pose pose;
  };
  std::vector<Part> parts;
};

using Geometry = std::variant<Sphere, Cuboid, Capsule, ConvexHull, Compound>;

/// A geometry with what follows from it. Elements refer to shapes by index, so equal elements share one.
struct Shape {
  Geometry geometry;
  double volume = 0;                     ///< [m^3]
  Vec3 inertia_per_mass = Vec3::Zero();  ///< principal moments divided by the mass [m^2]
  double bounding_radius = 0;            ///< about the centre of mass [m]
  const Sphere* sphere() const { return std::get_if<Sphere>(&geometry); }
};

/// Moves a geometry to its centre of mass and principal axes and works out volume, inertia and bounding radius.
/// Returns the shape; `frame`, if given, receives the pose of the shape's frame in the frame the geometry was given in.
/// Errors: InputError if an extent is not positive and finite, or the volume is zero. Cost: linear in vertices.
/// Source: closed forms for sphere, box, capsule; hulls by the divergence theorem over their facets (Mirtich 1996).
Shape make_shape(Geometry geometry, Pose* frame = nullptr);

}  // namespace moraine
