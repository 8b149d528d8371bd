// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/bonds.hpp"

#include <algorithm>

#include "physics/cell_grid.hpp"
#include "physics/scene/random.hpp"

namespace moraine {

std::vector<std::pair<ElementId, ElementId>> touching_pairs(const Scene& scene, double tolerance) {
  using Grid = CellGrid<double>;
  std::vector<Grid::Point> centres;
  std::vector<const Element*> spheres;
  double largest = 0;
  for (const Element& e : scene.elements) {
    const Sphere* sphere = scene.shape_of(e).sphere();
    if (!sphere) continue;
    const Vec3& p = e.state.pose.position;
    centres.push_back({p.x(), p.y(), p.z()});
    spheres.push_back(&e);
    largest = std::max(largest, sphere->radius);
  }
  std::vector<std::pair<ElementId, ElementId>> pairs;
  if (spheres.empty()) return pairs;

  Grid grid;
  grid.build(centres, 2 * largest * (1 + tolerance));
  const auto radius = [&](std::size_t i) { return scene.shape_of(*spheres[i]).sphere()->radius; };
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    grid.around(centres[i], [&](std::size_t j) {
      if (j <= i) return;
      const double reach = (radius(i) + radius(j)) * (1 + tolerance);
      const Vec3 between = spheres[i]->state.pose.position - spheres[j]->state.pose.position;
      if (between.squaredNorm() <= reach * reach) pairs.emplace_back(spheres[i]->id, spheres[j]->id);
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

double BreakLength::of(ElementId a, ElementId b) const {
  if (spread <= 0) return mean;
  return std::max(mean + spread * normal_of(seed, a, b), 1 + 0.1 * (mean - 1));
}

const Element* find_element(std::span<const Element> elements, ElementId id) {
  const auto at = std::lower_bound(elements.begin(), elements.end(), id,
                                   [](const Element& e, ElementId wanted) { return e.id < wanted; });
  return at != elements.end() && at->id == id ? &*at : nullptr;
}

}  // namespace moraine
