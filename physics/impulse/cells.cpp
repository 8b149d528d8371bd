// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/cells.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::impulse {
namespace {

/// Their number can be too large for an integer.
double count(const Vec& way, const float (&size)[3]) {
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) cells *= std::floor(static_cast<double>(way[axis] / size[axis])) + 1;
  return cells;
}

}  // namespace

Cells cells_in(const Extent& extent, const float (&size)[3], double most) {
  if (extent.empty()) return {};
  const Vec way = extent.high - extent.low;
  float larger[3];
  std::copy_n(size, 3, larger);
  while (count(way, larger) > most)
    for (float& s : larger) s *= 1.26F;
  Cells cells;
  for (int axis = 0; axis < 3; ++axis) {
    cells.low[axis] = extent.low[axis];
    cells.inverse[axis] = 1 / larger[axis];
    cells.size[axis] = static_cast<int>(way[axis] / larger[axis]) + 1;
  }
  return cells;
}

}  // namespace moraine::impulse
