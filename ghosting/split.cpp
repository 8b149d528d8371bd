// SPDX-License-Identifier: Apache-2.0
// The table of splits.
#include "ghosting/split.hpp"

#include <fmt/format.h>

#include <array>

#include "physics/errors.hpp"

namespace moraine {

std::span<const SplitRow> splits() {
  static const std::array table{
      SplitRow{"slabs", "equal slices along the longest axis: fewest neighbours, most ghosts", split_slabs},
      SplitRow{"rcb", "recursive bisection of the longest axis: compact boxes, few ghosts", split_rcb},
      SplitRow{"curve", "equal pieces of a Hilbert curve: compact for any shape of scene", split_curve},
  };
  return table;
}

Split find_split(std::string_view name) {
  for (const SplitRow& row : splits())
    if (row.name == name) return row.split;
  std::string known;
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
