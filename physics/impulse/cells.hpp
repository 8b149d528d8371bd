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

/// Counted along x first.
inline std::uint32_t cell_of(const Cells& cells, const Vec& p) {
  const int row = cells.along(2, p.z()) * cells.size[1] + cells.along(1, p.y());
  return static_cast<std::uint32_t>(row * cells.size[0] + cells.along(0, p.x()));
}

}  // namespace moraine::impulse
