// SPDX-License-Identifier: Apache-2.0
#include "ghosting/enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace moraine {
namespace {

/// Every edge joins two triangles.
bool closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax({t[k], t[(k + 1) % 3]})];
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 2; });
}

/// Solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983).
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double x = a.norm(), y = b.norm(), z = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + a.dot(c) * y + b.dot(c) * x);
}

/// A closed mesh fills the whole sky of a point inside, and nothing of one outside.
bool inside(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += solid_angle(mesh.vertices[t[0]] - point, mesh.vertices[t[1]] - point, mesh.vertices[t[2]] - point);
  return std::abs(sum) > 2 * std::numbers::pi;
}

Bounds box_of(const TriangleMesh& mesh) {
  Bounds box;
  for (const Vec3& v : mesh.vertices) box.add(v);
  return box;
}

Vec3 into(const Pose& frame, const Vec3& point) { return frame.orientation.conjugate() * (point - frame.position); }

/// The largest coordinate along `down` of a boundary at `pose`; infinite for planes that hold from below, the least
/// there is for other planes.
double depth(const Boundary& boundary, const Scene& scene, const Pose& pose, const Vec3& down) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  if (const auto* plane = std::get_if<Plane>(&boundary.geometry))
    return (pose.orientation * plane->normal).dot(down) < -1e-9 ? endless : -endless;
  if (const auto* solid = std::get_if<Solid>(&boundary.geometry))
    return down.dot(pose.position) + scene.shapes[solid->shape].bounding_radius;
  double deepest = -endless;
  for (const Vec3& v : std::get<TriangleMesh>(boundary.geometry).vertices)
    deepest = std::max(deepest, down.dot(pose.position + pose.orientation * v));
  return deepest;
}

}  // namespace

Enclosure::Enclosure(const Scene& scene) : scene_(&scene) {
  for (const Boundary& b : scene.boundaries) {
    const auto* mesh = std::get_if<TriangleMesh>(&b.geometry);
    if (std::holds_alternative<Plane>(b.geometry) || (mesh && closed(*mesh)))
      walls_.push_back({.boundary = &b, .mesh = mesh, .box = mesh ? box_of(*mesh) : Bounds{}});
  }
  if (!scene.gravity.isZero()) down_ = scene.gravity.normalized();
  first_lowest_ = -std::numeric_limits<double>::infinity();
  for (const Element& e : scene.elements)
    first_lowest_ = std::max(first_lowest_, down_.dot(e.state.pose.position) + scene.shape_of(e).bounding_radius);
  move(0);
}

void Enclosure::move(double t) {
  if (!scene_) return;
  for (Wall& w : walls_) w.place(w.boundary->motion.pose(w.boundary->pose, t));
  find_lowest(t);
}

void Enclosure::find_lowest(double t) {
  lowest_ = -std::numeric_limits<double>::infinity();
  for (const Boundary& b : scene_->boundaries)
    lowest_ = std::max(lowest_, depth(b, *scene_, b.motion.pose(b.pose, t), down_));
  // Without gravity or anything to fall past, nothing is below.
  if (down_.isZero() || !std::isfinite(lowest_)) lowest_ = std::numeric_limits<double>::infinity();
  lowest_ = std::max(lowest_, first_lowest_);
}

void Enclosure::Wall::place(const Pose& at) {
  pose = at;
  if (mesh) return;
  const auto& plane = std::get<Plane>(boundary->geometry);
  normal = at.orientation * plane.normal;
  offset = normal.dot(at.position + at.orientation * plane.point);
}

double Enclosure::Wall::beyond(const Vec3& point) const {
  return mesh ? box.distance(into(pose, point)) : offset - normal.dot(point);
}

/// Of a mesh, that the ball around the box is inside the mesh's box.
bool Enclosure::Wall::holds(const Bounds& all) const {
  const Vec3 middle = (all.min + all.max) / 2, half = (all.max - all.min) / 2;
  if (!mesh) return beyond(middle) + normal.cwiseAbs().dot(half) <= 0;
  const Vec3 room = Vec3::Constant(half.norm());
  const Vec3 at = into(pose, middle);
  return (at - room - box.min).minCoeff() >= 0 && (box.max - at - room).minCoeff() >= 0;
}

bool Enclosure::Wall::held(const Vec3& start) const {
  if (mesh) return inside(*mesh, into(boundary->pose, start));
  Wall first{.boundary = boundary};
  first.place(boundary->pose);
  return first.beyond(start) <= 0;
}

bool Enclosure::holds(const Bounds& box) const {
  const Vec3 middle = (box.min + box.max) / 2, half = (box.max - box.min) / 2;
  return below(middle) + down_.cwiseAbs().dot(half) <= 0 &&
         std::all_of(walls_.begin(), walls_.end(), [&](const Wall& w) { return w.holds(box); });
}

double Enclosure::beyond(const Vec3& point, const Vec3& start) const {
  double farthest = 0;
  for (const Wall& w : walls_) {
    const double far = w.beyond(point);
    if (far > farthest && w.held(start)) farthest = far;
  }
  return farthest;
}

}  // namespace moraine
