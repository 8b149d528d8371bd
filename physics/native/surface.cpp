// SPDX-License-Identifier: Apache-2.0
#include "physics/native/surface.hpp"

#include <algorithm>
#include <cmath>

#include "physics/hull.hpp"

namespace moraine::native {
namespace {

/// From a point of the surface outside: the normal points at the centre; `fallback` if both coincide.
Nearest from_point(const Vec3& point, const Vec3& centre, const Vec3& fallback) {
  const Vec3 away = centre - point;
  const double distance = away.norm();
  return {point, distance > 0 ? Vec3(away / distance) : fallback, distance};
}

Nearest find(const HalfSpace& s, const Vec3& centre) {
  const double distance = s.normal.dot(centre - s.point);
  return {centre - distance * s.normal, s.normal, distance};
}

/// Inside, the way out is through the nearest face.
Nearest find_inside(const Block& s, const Vec3& local) {
  Eigen::Index axis = 0;
  const double depth = (s.half_extents - local.cwiseAbs()).minCoeff(&axis);
  Vec3 normal = Vec3::Zero(), point = local;
  normal[axis] = local[axis] < 0 ? -1 : 1;
  point[axis] = normal[axis] * s.half_extents[axis];
  return {s.pose.position + s.pose.orientation * point, s.pose.orientation * normal, -depth};
}

Nearest find(const Block& s, const Vec3& centre) {
  const Vec3 local = s.pose.orientation.conjugate() * (centre - s.pose.position);
  const Vec3 clamped = local.cwiseMax(-s.half_extents).cwiseMin(s.half_extents);
  if (clamped == local) return find_inside(s, local);
  return from_point(s.pose.position + s.pose.orientation * clamped, centre, Vec3::UnitZ());
}

Nearest find(const Rod& s, const Vec3& centre) {
  const Vec3 along = s.to - s.from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp(along.dot(centre - s.from) / length2, 0.0, 1.0) : 0.0;
  Nearest n = from_point(s.from + t * along, centre, Vec3::UnitZ());
  n.point += s.radius * n.normal;
  n.distance -= s.radius;
  return n;
}

/// The point of a triangle that is nearest to p: by the regions of its corners, edges and face.
Vec3 closest(const Triangle& t, const Vec3& p) {
  const auto& [a, b, c] = t.corners;
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

Nearest find(const Triangle& t, const Vec3& centre) {
  const Vec3 normal = (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).normalized();
  return from_point(closest(t, centre), centre, normal);
}

Bounds box(const HalfSpace&) {
  const double all = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(-all), Vec3::Constant(all)};
}
Bounds box(const Block& s) {
  const Vec3 half = s.pose.orientation.toRotationMatrix().cwiseAbs() * s.half_extents;
  return {s.pose.position - half, s.pose.position + half};
}
Bounds box(const Rod& s) {
  Bounds b;
  b.add(s.from, s.radius);
  b.add(s.to, s.radius);
  return b;
}
Bounds box(const Triangle& t) {
  Bounds b;
  for (const Vec3& c : t.corners) b.add(c);
  return b;
}

template <class Mesh>
void add_triangles(const Mesh& mesh, const Pose& pose, std::vector<Surface>& out) {
  const auto placed = [&](std::uint32_t v) -> Vec3 { return pose.position + pose.orientation * mesh.vertices[v]; };
  for (const auto& t : mesh.triangles) out.push_back(Triangle{{placed(t[0]), placed(t[1]), placed(t[2])}});
}

void add(const Sphere& s, const Pose& pose, std::vector<Surface>& out) {
  out.push_back(Rod{pose.position, pose.position, s.radius});
}
void add(const Cuboid& s, const Pose& pose, std::vector<Surface>& out) { out.push_back(Block{pose, s.half_extents}); }
void add(const Capsule& s, const Pose& pose, std::vector<Surface>& out) {
  const Vec3 axis = pose.orientation * Vec3(0, 0, s.half_length);
  out.push_back(Rod{pose.position - axis, pose.position + axis, s.radius});
}
void add(const ConvexHull& s, const Pose& pose, std::vector<Surface>& out) {
  add_triangles(convex_hull(s.vertices), pose, out);
}
void add(const Compound& s, const Pose& pose, std::vector<Surface>& out) {
  for (const Compound::Part& part : s.parts) {
    const Pose placed{pose.position + pose.orientation * part.pose.position, pose.orientation * part.pose.orientation};
    std::visit([&](const auto& primitive) { add(primitive, placed, out); }, part.primitive);
  }
}

}  // namespace

Nearest nearest(const Surface& surface, const Vec3& centre) {
  return std::visit([&](const auto& s) { return find(s, centre); }, surface);
}

Bounds bounds(const Surface& surface) {
  return std::visit([](const auto& s) { return box(s); }, surface);
}

std::vector<Surface> surfaces(const Boundary& boundary, const Scene& scene, const Pose& pose) {
  std::vector<Surface> out;
  if (const auto* plane = std::get_if<Plane>(&boundary.geometry))
    out.push_back(
        HalfSpace{pose.position + pose.orientation * plane->point, pose.orientation * plane->normal.normalized()});
  else if (const auto* mesh = std::get_if<TriangleMesh>(&boundary.geometry))
    add_triangles(*mesh, pose, out);
  else
    std::visit([&](const auto& shape) { add(shape, pose, out); },
               scene.shapes[std::get<Solid>(boundary.geometry).shape].geometry);
  return out;
}

}  // namespace moraine::native
