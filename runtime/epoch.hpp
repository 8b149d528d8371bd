// SPDX-License-Identifier: Apache-2.0
// The rounds between two changes of neighbours.
#pragma once

#include <cstdint>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

struct Epoch {
  std::int64_t first_round = 0;
  std::int64_t rounds = 0;  ///< without the opening one

  std::int64_t rounds_with_opening() const { return rounds + 1; }
  /// `in_epoch` 0 is the opening round, which has the number of the one after.
  Round round(std::int64_t in_epoch) const { return {first_round + (in_epoch == 0 ? 0 : in_epoch - 1), in_epoch}; }
};

}  // namespace moraine::runtime
