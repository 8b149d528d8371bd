// SPDX-License-Identifier: Apache-2.0
#include "output/picture/outline.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "physics/hull.hpp"

namespace moraine {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Vec3 normal_of(const std::vector<Vec3>& v, const std::array<std::uint32_t, 3>& t) {
  return (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).normalized();
}

/// An edge shows if its triangles are not all in one plane, or if it has one only.
std::vector<Edge> mesh_edges(const std::vector<Vec3>& vertices, const Triangles& triangles) {
  const double flat = std::cos(20 * std::numbers::pi / 180);
  struct Use {
    Vec3 normal;
    int count = 0;
    bool bends = false;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Use> uses;
  for (const auto& t : triangles) {
    const Vec3 normal = normal_of(vertices, t);
    for (int k = 0; k < 3; ++k) {
      Use& use = uses[std::minmax(t[k], t[(k + 1) % 3])];
      if (use.count++ == 0) use.normal = normal;
      use.bends |= std::abs(use.normal.dot(normal)) < flat;
    }
  }
  std::vector<Edge> edges;
  for (const auto& [ends, use] : uses) {
    if (use.bends || use.count == 1) edges.push_back({vertices[ends.first], vertices[ends.second]});
  }
  return edges;
}

void add_circle(std::vector<Edge>& edges, const Vec3& centre, const Vec3& u, const Vec3& v) {
  constexpr int sides = 48;
  const auto point = [&](int k) -> Vec3 {
    const double angle = 2 * std::numbers::pi * k / sides;
    return centre + std::cos(angle) * u + std::sin(angle) * v;
  };
  for (int k = 0; k < sides; ++k) edges.push_back({point(k), point(k + 1)});
}

std::vector<Edge> edges_of(const Sphere& s) {
  std::vector<Edge> edges;
  for (int axis = 0; axis < 3; ++axis) {
    add_circle(edges, Vec3::Zero(), s.radius * Vec3::Unit(axis), s.radius * Vec3::Unit((axis + 1) % 3));
  }
  return edges;
}

std::vector<Edge> edges_of(const Cuboid& c) { return box_edges({-c.half_extents, c.half_extents}); }

std::vector<Edge> edges_of(const Capsule& c) {
  std::vector<Edge> edges;
  const Vec3 x = c.radius * Vec3::UnitX(), y = c.radius * Vec3::UnitY(), half = c.half_length * Vec3::UnitZ();
  for (const Vec3& end : {Vec3(-half), half}) add_circle(edges, end, x, y);
  for (const Vec3& side : {x, Vec3(-x), y, Vec3(-y)}) edges.push_back({side - half, side + half});
  return edges;
}

std::vector<Edge> edges_of(const ConvexHull& h) {
  const HullMesh mesh = convex_hull(h.vertices);
  return mesh_edges(mesh.vertices, mesh.triangles);
}

Vec3 placed(const Pose& pose, const Vec3& p) { return pose.position + pose.orientation * p; }

std::vector<Edge> placed(std::vector<Edge> edges, const Pose& pose) {
  for (auto& [a, b] : edges) std::tie(a, b) = std::make_pair(placed(pose, a), placed(pose, b));
  return edges;
}

std::vector<Edge> edges_of(const Compound& c) {
  std::vector<Edge> edges;
  for (const auto& [primitive, pose] : c.parts) {
    const auto part = placed(std::visit([](const auto& p) { return edges_of(p); }, primitive), pose);
    edges.insert(edges.end(), part.begin(), part.end());
  }
  return edges;
}

std::vector<Edge> edges_of(const Scene& scene, const Boundary& boundary) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&boundary.geometry)) {
    return mesh_edges(mesh->vertices, mesh->triangles);
  }
  if (const auto* solid = std::get_if<Solid>(&boundary.geometry)) {
    return std::visit([](const auto& g) { return edges_of(g); }, scene.shapes[solid->shape].geometry);
  }
  return {};
}

}  // namespace

std::vector<Edge> box_edges(const Bounds& box) {
  std::vector<Edge> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 4; ++side) {
      Vec3 from = box.min;
      if (side & 1) from[(axis + 1) % 3] = box.max[(axis + 1) % 3];
      if (side & 2) from[(axis + 2) % 3] = box.max[(axis + 2) % 3];
      Vec3 to = from;
      to[axis] = box.max[axis];
      edges.push_back({from, to});
    }
  }
  return edges;
}

std::vector<Edge> boundary_edges(const Scene& scene, const Frame& frame) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    const Boundary& boundary = scene.boundaries[i];
    const Pose& pose = i < frame.boundary_poses.size() ? frame.boundary_poses[i] : boundary.pose;
    const auto part = placed(edges_of(scene, boundary), pose);
    edges.insert(edges.end(), part.begin(), part.end());
  }
  return edges;
}

}  // namespace moraine
