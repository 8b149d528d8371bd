// SPDX-License-Identifier: Apache-2.0
// Scene shapes and boundaries as Bullet collision shapes, in Bullet's scaled units.
#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <vector>

#include "physics/scene/scene.hpp"

namespace moraine::bullet {

/// A Bullet shape with everything it points to.
struct OwnedShape {
  std::unique_ptr<btCollisionShape> shape;
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::unique_ptr<btTriangleMesh> mesh;
};

/// `scale` is 1 / length unit. Margins: none for spheres and capsules (exact), and for the others a hundredth of an
/// element diameter taken off the inside, so that the outer surface is the stated one.
OwnedShape make_shape(const Geometry& geometry, double scale);
OwnedShape make_shape(const TriangleMesh& mesh, double scale);
OwnedShape make_shape(const Plane& plane, double scale);

}  // namespace moraine::bullet
