// SPDX-License-Identifier: Apache-2.0
#include "output/picture/solid.hpp"

#include <cmath>
#include <limits>

#include "physics/hull.hpp"

namespace moraine {
namespace {

SolidPart part_of(const Sphere& s, const Pose& pose) { return Ball{pose.position, s.radius}; }

SolidPart part_of(const Capsule& c, const Pose& pose) {
  const Vec3 half = pose.orientation * Vec3(0, 0, c.half_length);
  return Rod{pose.position - half, pose.position + half, c.radius};
}

SolidPart part_of(const Cuboid& c, const Pose& pose) {
  Polytope box;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 normal = pose.orientation * Vec3::Unit(axis);
    const double middle = normal.dot(pose.position);
    box.faces.push_back({normal, middle + c.half_extents[axis]});
    box.faces.push_back({-normal, -middle + c.half_extents[axis]});
  }
  return box;
}

SolidPart part_of(const ConvexHull& h, const Pose& pose) {
  const HullMesh mesh = convex_hull(h.vertices);
  Polytope hull;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Vec3 normal = pose.orientation * (q - p).cross(r - p).normalized();
    hull.faces.push_back({normal, normal.dot(pose.position + pose.orientation * p)});
  }
  return hull;
}

std::optional<Hit> hit_ball(const Vec3& centre, double radius, const Vec3& origin, const Vec3& direction) {
  const Vec3 from = origin - centre;
  const double along = from.dot(direction);
  const double inside = along * along - from.squaredNorm() + radius * radius;
  if (inside < 0) return {};
  const double distance = -along - std::sqrt(inside);
  return Hit{distance, (from + distance * direction) / radius};
}

std::optional<Hit> hit_part(const Ball& ball, const Vec3& origin, const Vec3& direction) {
  return hit_ball(ball.centre, ball.radius, origin, direction);
}

/// On the open cylinder around the axis a + s u, 0 <= s <= length.
std::optional<Hit> hit_tube(const Rod& rod, const Vec3& u, double length, const Vec3& origin, const Vec3& direction) {
  const Vec3 from = origin - rod.a;
  const Vec3 flat_from = from - from.dot(u) * u, flat_direction = direction - direction.dot(u) * u;
  const double a = flat_direction.squaredNorm(), b = flat_from.dot(flat_direction);
  const double inside = b * b - a * (flat_from.squaredNorm() - rod.radius * rod.radius);
  if (inside < 0 || a < 1e-12) return {};
  const double distance = (-b - std::sqrt(inside)) / a;
  const double along = (from + distance * direction).dot(u);
  if (along < 0 || along > length) return {};
  return Hit{distance, (flat_from + distance * flat_direction) / rod.radius};
}

std::optional<Hit> nearer(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  return !a || (b && b->distance < a->distance) ? b : a;
}

std::optional<Hit> hit_part(const Rod& rod, const Vec3& origin, const Vec3& direction) {
  const std::optional<Hit> caps =
      nearer(hit_ball(rod.a, rod.radius, origin, direction), hit_ball(rod.b, rod.radius, origin, direction));
  const double length = (rod.b - rod.a).norm();
  return length > 0 ? nearer(caps, hit_tube(rod, (rod.b - rod.a) / length, length, origin, direction)) : caps;
}

std::optional<Hit> hit_part(const Polytope& polytope, const Vec3& origin, const Vec3& direction) {
  Hit entry{-std::numeric_limits<double>::infinity(), Vec3::Zero()};
  double exit = std::numeric_limits<double>::infinity();
  for (const auto& [normal, offset] : polytope.faces) {
    const double speed = normal.dot(direction), gap = offset - normal.dot(origin);
    if (speed < 0 && gap / speed > entry.distance) entry = {gap / speed, normal};
    if (speed > 0) exit = std::min(exit, gap / speed);
    if (speed == 0 && gap < 0) return {};
  }
  return entry.distance < exit ? std::optional(entry) : std::nullopt;
}

}  // namespace

std::vector<SolidPart> solid_parts(const Geometry& geometry) {
  std::vector<SolidPart> parts;
  if (const auto* compound = std::get_if<Compound>(&geometry)) {
    for (const auto& [primitive, pose] : compound->parts) {
      parts.push_back(std::visit([&p = pose](const auto& solid) { return part_of(solid, p); }, primitive));
    }
    return parts;
  }
  std::visit(
      [&](const auto& solid) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(solid)>, Compound>) parts.push_back(part_of(solid, {}));
      },
      geometry);
  return parts;
}

std::optional<Hit> hit(const std::vector<SolidPart>& parts, const Vec3& origin, const Vec3& direction) {
  std::optional<Hit> nearest;
  for (const SolidPart& part : parts) {
    nearest = nearer(nearest, std::visit([&](const auto& solid) { return hit_part(solid, origin, direction); }, part));
  }
  return nearest;
}

}  // namespace moraine
