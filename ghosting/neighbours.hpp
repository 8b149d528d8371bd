// SPDX-License-Identifier: Apache-2.0
// Which sub-models can meet before the next epoch, and how long that holds.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "physics/types.hpp"

namespace moraine {

/// What a sub-model's elements may do until the next epoch.
struct Reach {
  Bounds bounds;
  double max_speed = 0;  ///< [m/s]
};

/// The box of all.
Bounds all_of(std::span<const Reach> reaches);

struct Neighbourhood {
  std::vector<std::pair<SubModelId, SubModelId>> pairs;  ///< (low, high), ascending
  std::int64_t rounds = 1;                               ///< for which no other pair can meet
};

/// Sub-models whose bounds come closer than a margin are neighbours. The margin is what elements may travel in the
/// epoch at twice today's largest speed plus free fall: two diameters, or more if that would last less than 8 rounds.
/// Cost: of n sub-models, n log n and what overlaps along the longest axis of the whole.
/// `driven`: speed of what pushes them, if that is more than theirs [m/s].
Neighbourhood find_neighbours(std::span<const Reach> reaches, double driven, double diameter, double gravity,
                              double substep, std::int64_t at_most);

}  // namespace moraine
