// SPDX-License-Identifier: Apache-2.0
// The boundaries of a scene as balls meet them: where they are now, which balls are near, where those touch.
#pragma once

#include <span>
#include <vector>

#include "physics/native/sized_grid.hpp"
#include "physics/native/surface.hpp"

namespace moraine::native {

/// A ball that may touch a surface of a wall before anything has moved half a skin.
struct WallCandidate {
  std::uint32_t ball = 0;
  std::uint32_t wall = 0;
  std::uint32_t surface = 0;
  auto operator<=>(const WallCandidate&) const = default;
};

/// A boundary's place in a step.
class Wall {
 public:
  Wall(const Boundary& boundary, const Scene& scene);

  /// Stands and moves as prescribed for time t [s].
  void move(double t);
  bool moves() const { return boundary_->motion.moves(); }
  std::uint32_t material() const { return boundary_->material; }
  Vec3 velocity(const Vec3& point) const { return twist_.linear + twist_.angular.cross(point - pose_.position); }
  const Vec3& spin() const { return twist_.angular; }
  std::size_t surfaces() const { return surfaces_.size(); }
  Nearest nearest(std::size_t surface, const Vec3& centre) const;
  /// Box around a surface, world frame.
  Bounds box(std::size_t surface) const;
  /// It turns and has no end: any ball may meet it in any step.
  bool sweeps() const;

  void mark() { marked_ = pose_; }
  /// Farthest that a point of it may have come since mark() [m]. Not for those that sweep.
  double moved() const;

 private:
  const Boundary* boundary_;
  std::vector<Surface> surfaces_;  ///< in the boundary's frame if it moves, else in the world's
  double reach_ = 0;               ///< of the surfaces from the frame's origin [m]
  Pose pose_, marked_;
  Twist twist_;
};

class Walls {
 public:
  explicit Walls(const Scene& scene);

  std::size_t size() const { return walls_.size(); }
  const Wall& operator[](std::size_t i) const { return walls_[i]; }
  void move(double t);
  /// Largest way that any wall went since the last find() [m].
  double moved() const;

  /// Candidates among the balls that are not passive, ascending. Cost: linear in surfaces and candidates.
  void find(const SizedGrid& grid, std::span<const Ball> balls, std::span<const std::uint8_t> passive, double skin,
            std::vector<WallCandidate>& out);

 private:
  std::vector<Wall> walls_;
};

/// Where a ball touches one wall; `candidates` are those of this ball and this wall. The deepest comes first. One that
/// does not rise above the tangent planes of those before is left out: it is the edge of a face already touched.
void find_touches(const Wall& wall, const Ball& ball, std::span<const WallCandidate> candidates,
                  std::vector<Nearest>& out);

}  // namespace moraine::native
