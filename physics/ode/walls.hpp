// SPDX-License-Identifier: Apache-2.0
// Where bodies touch boundaries: spheres by the search that all engines for
// spheres use, other shapes by ODE's colliders.
#pragma once

#include <vector>

#include "physics/native/walls.hpp"
#include "physics/ode/bodies.hpp"

namespace moraine::ode {

/// A point where a body touches another or a boundary, as ODE's colliders give
/// it.
struct Touch {
  Place a = 0;
  std::uint32_t b = 0;  ///< a place, or a boundary's index
  bool with_boundary = false;
  dContactGeom at{};  ///< normal towards a
};

class WallTouches {
 public:
  WallTouches(const Scene& scene, const Units& units);

  native::Walls& walls() { return walls_; }
  const native::Walls& walls() const { return walls_; }
  void list(const native::SizedGrid& grid, std::span<const native::Ball> balls, std::span<const std::uint8_t> passive,
            double skin) {
    walls_.find(grid, balls, passive, skin, candidates_);
  }
  /// Boundaries stand where they are at time t [s].
  void move(double t);
  /// Appends all touches, ascending by body and boundary.
  void find(const Bodies& bodies, std::vector<Touch>& out);

 private:
  using Group = std::span<const native::WallCandidate>;
  /// One boundary in ODE's terms: a mesh of its triangles or a geometry per
  /// surface.
  struct Solid {
    std::vector<native::Surface> surfaces;  ///< in the boundary's frame
    std::vector<Geom> pieces;
    std::unique_ptr<Mesh> mesh;
  };
  void place_solid(std::size_t wall, double t);
  void meet_ball(const Bodies& bodies, Group group, std::vector<Touch>& out);
  void meet_parts(const Bodies& bodies, Group group, std::vector<Touch>& out);

  const Scene& scene_;
  const Units& units_;
  native::Walls walls_;
  std::vector<Solid> solids_;
  std::vector<native::WallCandidate> candidates_;
  std::vector<native::Nearest> nearest_;
};

/// Appends where two geometries touch.
void collide(dGeomID a, dGeomID b, Touch touch, std::vector<Touch>& out);

}  // namespace moraine::ode
