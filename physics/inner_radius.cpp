// SPDX-License-Identifier: Apache-2.0
#include "physics/inner_radius.hpp"

#include <algorithm>
#include <limits>

#include "physics/hull.hpp"

namespace moraine {
namespace {

double inside(const Sphere& s) { return s.radius; }
double inside(const Cuboid& c) { return c.half_extents.minCoeff(); }
double inside(const Capsule& c) { return c.radius; }

double inside(const ConvexHull& hull) {
  const HullMesh mesh = convex_hull(hull.vertices);
  Vec3 centre = Vec3::Zero();
  for (const Vec3& v : mesh.vertices) centre += v / static_cast<double>(mesh.vertices.size());
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a);
    if (normal.norm() > 0) least = std::min(least, std::abs(normal.normalized().dot(a - centre)));
  }
  return least;
}

double inside(const Compound& compound) {
  double thickest = 0;
  for (const auto& part : compound.parts)
    thickest = std::max(thickest, std::visit([](const auto& p) { return inside(p); }, part.primitive));
  return thickest;
}

}  // namespace

double inner_radius(const Geometry& geometry) {
  return std::visit([](const auto& g) { return inside(g); }, geometry);
}

}  // namespace moraine
