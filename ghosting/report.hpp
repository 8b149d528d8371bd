// SPDX-License-Identifier: Apache-2.0
// What all ranks know of a sub-model between epochs, wherever it is.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosting/ledger.hpp"
#include "physics/types.hpp"

namespace moraine {

struct Report {
  Bounds bounds;
  double max_speed = 0;  ///< of its elements [m/s]
  Ledger ledger;
  double disagreement = 0;  ///< sum of squared speeds by which copies disagreed [m^2/s^2]
  std::uint64_t disagreements = 0;
  std::uint64_t ghosts = 0;        ///< now
  std::uint64_t ghost_rounds = 0;  ///< sum over rounds of the number of ghosts
  std::uint64_t rounds = 0;
  std::vector<std::uint32_t> broken_bonds;  ///< ascending
};

}  // namespace moraine
