// SPDX-License-Identifier: Apache-2.0
// A box of cells around bodies.
#pragma once

#include <limits>

#include "physics/impulse/pair_kernels.hpp"
#include "physics/impulse/units.hpp"

namespace moraine::impulse {

/// What is around bodies that are somewhere.
struct Extent {
  Vec low = Vec::Constant(std::numeric_limits<float>::max()), high = -low;

  bool empty() const { return high.x() < low.x(); }
  void add(const Vec& p) {
    if (p.allFinite()) add(p, p);
  }
  void add(const Vec& from, const Vec& to) {
    low = low.cwiseMin(from);
    high = high.cwiseMax(to);
  }
};

/// Cells of this size [x, y, z], or larger ones where there would be more than `most`. One cell if nothing was added.
Cells cells_in(const Extent& extent, const float (&size)[3], double most);

inline std::size_t cell_count(const Cells& c) {
  return static_cast<std::size_t>(c.size[0]) * static_cast<std::size_t>(c.size[1]) *
         static_cast<std::size_t>(c.size[2]);
}

/// The nearest one for what lies outside, the first one for what is nowhere.
inline int cell_along(const Cells& cells, int axis, float x) {
  const float c = (x - cells.low[axis]) * cells.inverse[axis];
  const int last = cells.size[axis] - 1;
  return c > 0 ? (c < static_cast<float>(last) ? static_cast<int>(c) : last) : 0;
}
/// Counted along x first.
inline std::uint32_t cell_of(const Cells& cells, const Vec& p) {
  const int row = cell_along(cells, 2, p.z()) * cells.size[1] + cell_along(cells, 1, p.y());
  return static_cast<std::uint32_t>(row * cells.size[0] + cell_along(cells, 0, p.x()));
}

}  // namespace moraine::impulse
