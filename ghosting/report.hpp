// SPDX-License-Identifier: Apache-2.0
// What all ranks know of a sub-model between epochs, wherever it is.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosting/ledger.hpp"
#include "physics/types.hpp"

namespace moraine {

/// The element for which a number is largest: the first of them by sub-model and id.
struct Worst {
  double value = 0;
  ElementId element = 0;

  /// The id is read only if it is wanted: it lies in the scene, far from motions.
  void note(double other, const ElementId& id) {
    if (other > value) *this = {other, id};
  }
  void note(const Worst& other) { note(other.value, other.element); }
};

/// Of a sub-model's elements between epochs.
struct Extremes {
  Worst speed;   ///< [m/s]
  Worst stride;  ///< way within a substep [element radii]
  Worst beyond;  ///< depth of the centre behind what held it at the start [element radii]
  Worst below;   ///< depth of the centre below the lowest boundary [element radii]

  void note(const Extremes& o) {
    speed.note(o.speed);
    stride.note(o.stride);
    beyond.note(o.beyond);
    below.note(o.below);
  }
};

struct Report {
  Bounds bounds;
  double max_speed = 0;  ///< of its elements [m/s]
  Extremes extremes;
  Ledger ledger;
  double disagreement = 0;  ///< sum of squared speeds by which copies disagreed [m^2/s^2]
  std::uint64_t disagreements = 0;
  std::uint64_t ghosts = 0;        ///< now
  std::uint64_t ghost_rounds = 0;  ///< sum over rounds of the number of ghosts
  std::uint64_t rounds = 0;
  std::uint64_t rested = 0;                 ///< sum over rounds of the elements that did not advance
  std::vector<std::uint32_t> broken_bonds;  ///< ascending
};

}  // namespace moraine
