// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/shapes.hpp"

#include "physics/bullet/units.hpp"

namespace moraine::bullet {
namespace {

// Bullet's collision margin [element diameters]; its default of 0.04 is meant for bodies of about a metre.
constexpr double margin = 0.01;

btVector3 scaled(const Vec3& v, double scale) { return Units::raw(Vec3(v * scale)); }

/// A margin that the shape can hold inside itself.
btScalar inner_margin(double smallest_extent) { return static_cast<btScalar>(std::min(margin, 0.1 * smallest_extent)); }

std::unique_ptr<btCollisionShape> primitive(const Sphere& s, double scale) {
  return std::make_unique<btSphereShape>(static_cast<btScalar>(s.radius * scale));
}

std::unique_ptr<btCollisionShape> primitive(const Cuboid& c, double scale) {
  auto shape = std::make_unique<btBoxShape>(scaled(c.half_extents, scale));
  shape->setMargin(inner_margin(c.half_extents.minCoeff() * scale));
  return shape;
}

std::unique_ptr<btCollisionShape> primitive(const Capsule& c, double scale) {
  return std::make_unique<btCapsuleShapeZ>(static_cast<btScalar>(c.radius * scale),
                                           static_cast<btScalar>(2 * c.half_length * scale));
}

/// A hull's margin lies outside its points, so the points are drawn in towards the centre of mass by as much.
std::unique_ptr<btCollisionShape> primitive(const ConvexHull& hull, double scale) {
  double reach = 0;
  for (const Vec3& v : hull.vertices) reach = std::max(reach, v.norm() * scale);
  const double m = inner_margin(reach);
  auto shape = std::make_unique<btConvexHullShape>();
  for (const Vec3& v : hull.vertices) shape->addPoint(scaled(v, scale * (1 - m / reach)), false);
  shape->setMargin(static_cast<btScalar>(m));
  shape->recalcLocalAabb();
  return shape;
}

std::unique_ptr<btCollisionShape> primitive(const Primitive& p, double scale) {
  return std::visit([&](const auto& g) { return primitive(g, scale); }, p);
}

btTransform local_pose(const Pose& p, double scale) {
  return btTransform(Units::raw(p.orientation), scaled(p.position, scale));
}

OwnedShape owned(const Compound& compound, double scale) {
  OwnedShape out;
  auto shape = std::make_unique<btCompoundShape>(false);
  for (const Compound::Part& part : compound.parts) {
    out.parts.push_back(primitive(part.primitive, scale));
    shape->addChildShape(local_pose(part.pose, scale), out.parts.back().get());
  }
  out.shape = std::move(shape);
  return out;
}

template <class T>
OwnedShape owned(const T& g, double scale) {
  OwnedShape out;
  out.shape = primitive(g, scale);
  return out;
}

}  // namespace

OwnedShape make_shape(const Geometry& geometry, double scale) {
  return std::visit([&](const auto& g) { return owned(g, scale); }, geometry);
}

OwnedShape make_shape(const TriangleMesh& mesh, double scale) {
  OwnedShape out;
  out.mesh = std::make_unique<btTriangleMesh>();
  for (const auto& t : mesh.triangles)
    out.mesh->addTriangle(scaled(mesh.vertices[t[0]], scale), scaled(mesh.vertices[t[1]], scale),
                          scaled(mesh.vertices[t[2]], scale), false);
  auto shape = std::make_unique<btBvhTriangleMeshShape>(out.mesh.get(), true);
  shape->setMargin(0);
  out.shape = std::move(shape);
  return out;
}

OwnedShape make_shape(const Plane& plane, double) {
  OwnedShape out;
  out.shape = std::make_unique<btStaticPlaneShape>(Units::raw(Vec3(plane.normal.normalized())), btScalar(0));
  out.shape->setMargin(0);
  return out;
}

}  // namespace moraine::bullet
