// SPDX-License-Identifier: Apache-2.0
#include "physics/ode/walls.hpp"

#include <algorithm>
#include <array>
#include <mutex>

namespace moraine::ode {
namespace {

constexpr int most_points = 32;  ///< of two geometries

/// Debian builds ODE without `ODE_EXT_mt_collisions`: its colliders for meshes share one workspace.
std::mutex mesh_workspace;

}  // namespace

void collide(dGeomID a, dGeomID b, Touch touch, std::vector<Touch>& out) {
  std::array<dContactGeom, most_points> points;
  const int count = dCollide(a, b, most_points, points.data(), sizeof(dContactGeom));
  for (int k = 0; k < count; ++k) {
    touch.at = points[static_cast<std::size_t>(k)];
    out.push_back(touch);
  }
}

WallTouches::WallTouches(const Scene& scene, const Units& units)
    : scene_(scene), units_(units), walls_(scene), solids_(scene.boundaries.size()) {
  for (std::size_t w = 0; w < solids_.size(); ++w) {
    Solid& s = solids_[w];
    s.surfaces = native::surfaces(scene.boundaries[w], scene, Pose{});
    const auto triangles = std::stable_partition(s.surfaces.begin(), s.surfaces.end(), [](const auto& surface) {
      return !std::holds_alternative<native::Triangle>(surface);
    });
    for (auto piece = s.surfaces.begin(); piece != triangles; ++piece)
      s.pieces.push_back(make_piece(*piece, 1 / units.length));
    if (triangles != s.surfaces.end())
      s.mesh = std::make_unique<Mesh>(std::span(triangles, s.surfaces.end()), 1 / units.length);
    place_solid(w, 0);
  }
}

void WallTouches::place_solid(std::size_t wall, double t) {
  const Boundary& b = scene_.boundaries[wall];
  Pose pose = b.motion.pose(b.pose, t);
  pose.position = units_.position(pose.position);
  const Solid& s = solids_[wall];
  if (s.mesh) place(s.mesh->geom(), pose);
  for (std::size_t k = 0; k < s.pieces.size(); ++k)
    place_piece(s.pieces[k].get(), s.surfaces[k], 1 / units_.length, pose);
}

void WallTouches::move(double t) {
  walls_.move(t);
  for (std::size_t w = 0; w < solids_.size(); ++w)
    if (walls_[w].moves()) place_solid(w, t);
}

void WallTouches::find(const Bodies& bodies, std::vector<Touch>& out) {
  for (std::size_t begin = 0, end = 0; begin < candidates_.size(); begin = end) {
    const native::WallCandidate& first = candidates_[begin];
    while (end < candidates_.size() && candidates_[end].ball == first.ball && candidates_[end].wall == first.wall)
      ++end;
    if (!bodies.sound(first.ball)) continue;
    const Group group = Group(candidates_).subspan(begin, end - begin);
    if (bodies.shape(first.ball).sphere())
      meet_ball(bodies, group, out);
    else
      meet_parts(bodies, group, out);
  }
}

void WallTouches::meet_ball(const Bodies& bodies, Group group, std::vector<Touch>& out) {
  const native::Ball ball = bodies.ball(group.front().ball);
  native::find_touches(walls_[group.front().wall], ball, group, nearest_);
  for (const native::Nearest& n : nearest_) {
    Touch touch{group.front().ball, group.front().wall, true, {}};
    const Vec3 point = units_.position(n.point);
    for (int k = 0; k < 3; ++k) {
      touch.at.pos[k] = point[k];
      touch.at.normal[k] = n.normal[k];
    }
    touch.at.depth = (ball.radius - n.distance) / units_.length;
    out.push_back(touch);
  }
}

void WallTouches::meet_parts(const Bodies& bodies, Group group, std::vector<Touch>& out) {
  const Touch touch{group.front().ball, group.front().wall, true, {}};
  const Solid& solid = solids_[touch.b];
  for (const Geom& part : bodies.parts(touch.a)) {
    if (solid.mesh) {
      const std::lock_guard turn(mesh_workspace);
      collide(part.get(), solid.mesh->geom(), touch, out);
    }
    for (const Geom& piece : solid.pieces) collide(part.get(), piece.get(), touch, out);
  }
}

}  // namespace moraine::ode
