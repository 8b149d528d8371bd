// SPDX-License-Identifier: Apache-2.0
// How far bodies that lie near each other have come towards each other since they were listed. What moves together
// needs no new list, however fast it is.
#pragma once

#include <span>
#include <vector>

#include "physics/impulse/cells.hpp"

namespace moraine::impulse {

class Drift {
 public:
  /// Bodies are listed at these places, radius in the last lane.
  /// `gap`: of bodies whose surfaces are farther apart than this, between() does not speak.
  void list(std::span<const Vec> at, float gap);

  /// Not less than the largest difference between the ways of two bodies that were near each other, from where they
  /// were listed to where they are now: the diagonal of the box around all ways from a cell and those next to it.
  /// Bodies that are nowhere do not count. Cost: linear in bodies and cells, at most one per body.
  float between(std::span<const Vec> at, std::span<const Vec> now);

 private:
  void collect(std::span<const Vec> at, std::span<const Vec> now);
  Extent around(int x, int y, int z) const;
  const Extent& ways(int x, int y, int z) const {
    return ways_[static_cast<std::size_t>((z * cells_.size[1] + y) * cells_.size[0] + x)];
  }

  Cells cells_;
  std::vector<Extent> ways_;  ///< of every cell
};

}  // namespace moraine::impulse
