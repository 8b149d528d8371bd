// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/drift.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::impulse {
namespace {

/// Those next to a cell along an axis, and itself.
struct Range {
  Range(int cell, int size) : first(std::max(cell - 1, 0)), last(std::min(cell + 1, size - 1)) {}
  int first, last;
};

}  // namespace

void Drift::list(std::span<const Vec> at, float gap) {
  Extent extent;
  for (const Vec& p : at) extent.add(p);
  const float cell = 2 * std::max(extent.high.w(), 0.0F) + gap;
  cells_ = cells_in(extent, {cell, cell, cell}, static_cast<double>(at.size()) + 27);
}

float Drift::between(std::span<const Vec> at, std::span<const Vec> now) {
  collect(at, now);
  float largest2 = 0;
  for (int z = 0; z < cells_.size[2]; ++z)
    for (int y = 0; y < cells_.size[1]; ++y)
      for (int x = 0; x < cells_.size[0]; ++x) {
        if (ways(x, y, z).empty()) continue;
        const Extent all = around(x, y, z);
        largest2 = std::max(largest2, (all.high - all.low).squaredNorm());
      }
  return std::sqrt(largest2);
}

void Drift::collect(std::span<const Vec> at, std::span<const Vec> now) {
  ways_.assign(cell_count(cells_), {});
  for (std::size_t i = 0; i < at.size(); ++i) ways_[cell_of(cells_, at[i])].add(now[i] - at[i]);
}

Extent Drift::around(int x, int y, int z) const {
  const Range i(x, cells_.size[0]), j(y, cells_.size[1]), k(z, cells_.size[2]);
  Extent all;
  for (int c = k.first; c <= k.last; ++c)
    for (int b = j.first; b <= j.last; ++b)
      for (int a = i.first; a <= i.last; ++a) all.add(ways(a, b, c).low, ways(a, b, c).high);
  return all;
}

}  // namespace moraine::impulse
