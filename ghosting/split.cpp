// SPDX-License-Identifier: Apache-2.0
// The table of splits.
#include "ghosting/split.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "physics/errors.hpp"

namespace moraine {

std::span<const SplitRow> splits() {
  static const std::array table{
      SplitRow{"slabs", "equal slices along the longest axis: fewest neighbours, most ghosts", split_slabs},
      SplitRow{"rcb", "recursive bisection of the longest axis: compact boxes, few ghosts", split_rcb},
      SplitRow{"pillars", "rcb seen along gravity: what bears on each other stays together, loads are not cut",
               split_pillars},
      SplitRow{"curve", "equal pieces of a Hilbert curve: compact for any shape of scene", split_curve},
  };
  return table;
}

namespace {

/// Mean width of a pillar if the scene's cross-section seen along gravity is shared by `parts`.
double pillar_width(const Scene& scene, std::size_t parts) {
  const Vec3 down = scene.gravity.normalized();
  Bounds box;
  for (const Element& e : scene.elements)
    box.add(e.state.pose.position - down * down.dot(e.state.pose.position), scene.shape_of(e).bounding_radius);
  const Vec3 extent = box.max - box.min;
  const double smallest = scene.typical_diameter();
  double area = 1;
  for (int a = 0; a < 3; ++a)
    if (extent[a] > 1.5 * smallest) area *= extent[a];
  return std::sqrt(area / static_cast<double>(parts));
}

std::string_view automatic(const Scene& scene, std::size_t parts) {
  if (scene.elements.empty() || scene.gravity.isZero()) return "rcb";
  return pillar_width(scene, parts) >= 5 * scene.typical_diameter() ? "pillars" : "rcb";
}

}  // namespace

const SplitRow& find_split(std::string_view name, const Scene& scene, std::size_t parts) {
  const std::string_view wanted = name == "auto" ? automatic(scene, parts) : name;
  for (const SplitRow& row : splits())
    if (row.name == wanted) return row;
  std::string known = "\n  auto         pillars where they would be wide enough, else rcb";
  for (const SplitRow& row : splits()) known += fmt::format("\n  {:<12} {}", row.name, row.help);
  throw InputError(fmt::format("unknown split '{}', expected one of:{}", name, known));
}

int longest_axis(std::span<const Vec3> positions, std::span<const std::uint32_t> subset) {
  Bounds box;
  for (const std::uint32_t i : subset) box.add(positions[i]);
  const Vec3 extent = box.max - box.min;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (extent[a] > extent[axis]) axis = a;
  return axis;
}

}  // namespace moraine
