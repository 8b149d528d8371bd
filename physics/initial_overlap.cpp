// SPDX-License-Identifier: Apache-2.0
#include "physics/initial_overlap.hpp"

#include "physics/native/verlet_list.hpp"
#include "physics/native/walls.hpp"

namespace moraine {
namespace {

/// The spheres of a scene, and whose they are.
struct Spheres {
  std::vector<native::Ball> balls;
  std::vector<ElementId> ids;
  native::SizedGrid grid;
  std::vector<std::uint8_t> passive;

  explicit Spheres(const Scene& scene) {
    for (const Element& e : scene.elements) {
      const Sphere* sphere = scene.shape_of(e).sphere();
      if (!sphere) continue;
      balls.push_back({e.state.pose.position, sphere->radius});
      ids.push_back(e.id);
    }
    grid.build(balls, 0);
    passive.assign(balls.size(), 0);
  }
};

void note(InitialOverlap& deepest, double overlap, double radius, const InitialOverlap& found) {
  if (overlap / (2 * radius) <= deepest.depth) return;
  deepest = found;
  deepest.depth = overlap / (2 * radius);
}

void look_at_pairs(const Spheres& s, InitialOverlap& deepest) {
  native::VerletList pairs;
  pairs.build(s.grid, s.balls, s.passive, 0);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::uint32_t i = pairs.lower()[k], j = pairs.higher()[k];
    const native::Ball &a = s.balls[i], &b = s.balls[j];
    note(deepest, a.radius + b.radius - (a.centre - b.centre).norm(), std::min(a.radius, b.radius),
         {0, s.ids[i], s.ids[j], false});
  }
}

void look_at_boundaries(const Spheres& s, const Scene& scene, InitialOverlap& deepest) {
  native::Walls walls(scene);
  std::vector<native::WallCandidate> candidates;
  walls.find(s.grid, s.balls, s.passive, 0, candidates);
  for (const native::WallCandidate& c : candidates) {
    const native::Ball& ball = s.balls[c.ball];
    note(deepest, ball.radius - walls[c.wall].nearest(c.surface, ball.centre).distance, ball.radius,
         {0, s.ids[c.ball], c.wall, true});
  }
}

}  // namespace

InitialOverlap deepest_overlap(const Scene& scene) {
  InitialOverlap deepest;
  const Spheres spheres(scene);
  if (spheres.balls.empty()) return deepest;
  look_at_pairs(spheres, deepest);
  look_at_boundaries(spheres, scene, deepest);
  return deepest;
}

}  // namespace moraine
