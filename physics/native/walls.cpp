// SPDX-License-Identifier: Apache-2.0
#include "physics/native/walls.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::native {
namespace {

constexpr double same_plane = 1e-6;  ///< of the radius

std::vector<Vec3> corners(const Bounds& box) {
  std::vector<Vec3> out;
  for (int c = 0; c < 8; ++c)
    out.emplace_back(c & 1 ? box.max.x() : box.min.x(), c & 2 ? box.max.y() : box.min.y(),
                     c & 4 ? box.max.z() : box.min.z());
  return out;
}

bool endless(const Bounds& box) { return !box.min.allFinite(); }

}  // namespace

Wall::Wall(const Boundary& boundary, const Scene& scene)
    : boundary_(&boundary), surfaces_(native::surfaces(boundary, scene, moves() ? Pose{} : boundary.pose)) {
  for (const Surface& s : surfaces_) {
    const Bounds b = bounds(s);
    reach_ = std::max({reach_, b.min.norm(), b.max.norm(), b.min.cwiseAbs().cwiseMax(b.max.cwiseAbs()).norm()});
  }
  move(0);
  mark();
}

void Wall::move(double t) {
  pose_ = boundary_->motion.pose(boundary_->pose, t);
  twist_ = boundary_->motion.twist(boundary_->pose, t);
}

Nearest Wall::nearest(std::size_t surface, const Vec3& centre) const {
  if (!moves()) return native::nearest(surfaces_[surface], centre);
  Nearest n = native::nearest(surfaces_[surface], pose_.orientation.conjugate() * (centre - pose_.position));
  n.point = pose_.position + pose_.orientation * n.point;
  n.normal = pose_.orientation * n.normal;
  return n;
}

Bounds Wall::box(std::size_t surface) const {
  const Bounds local = bounds(surfaces_[surface]);
  if (endless(local) || !moves()) return local;
  Bounds out;
  for (const Vec3& c : corners(local)) out.add(pose_.position + pose_.orientation * c);
  return out;
}

bool Wall::sweeps() const { return !std::isfinite(reach_) && !boundary_->motion.velocity.angular.isZero(0); }

double Wall::moved() const {
  if (!moves()) return 0;
  const double turned = marked_.orientation.angularDistance(pose_.orientation);
  const double way = (pose_.position - marked_.position).norm();
  return turned > 0 && std::isfinite(reach_) ? way + turned * reach_ : way;
}

Walls::Walls(const Scene& scene) {
  for (const Boundary& b : scene.boundaries) walls_.emplace_back(b, scene);
}

void Walls::move(double t) {
  for (Wall& w : walls_)
    if (w.moves()) w.move(t);
}

double Walls::moved() const {
  double most = 0;
  for (const Wall& w : walls_)
    if (!w.sweeps()) most = std::max(most, w.moved());
  return most;
}

void Walls::find(const SizedGrid& grid, std::span<const Ball> balls, std::span<const std::uint8_t> passive, double skin,
                 std::vector<WallCandidate>& out) {
  out.clear();
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    walls_[w].mark();
    const bool all = walls_[w].sweeps();
    for (std::uint32_t s = 0; s < walls_[w].surfaces(); ++s)
      grid.near_box(walls_[w].box(s), skin, [&](std::uint32_t i) {
        if (passive[i]) return;
        if (all || walls_[w].nearest(s, balls[i].centre).distance < balls[i].radius + skin) out.push_back({i, w, s});
      });
  }
  std::sort(out.begin(), out.end());
}

void find_touches(const Wall& wall, const Ball& ball, std::span<const WallCandidate> candidates,
                  std::vector<Nearest>& out) {
  out.clear();
  for (const WallCandidate& c : candidates) {
    const Nearest n = wall.nearest(c.surface, ball.centre);
    if (n.distance < ball.radius) out.push_back(n);
  }
  if (out.size() < 2) return;
  std::sort(out.begin(), out.end(), [](auto& a, auto& b) { return a.distance < b.distance; });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const bool edge = std::any_of(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(kept), [&](const Nearest& a) {
      return a.normal.dot(out[k].point - a.point) <= same_plane * ball.radius;
    });
    if (!edge) out[kept++] = out[k];
  }
  out.resize(kept);
}

}  // namespace moraine::native
