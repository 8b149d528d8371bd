// SPDX-License-Identifier: Apache-2.0
// Settings that no other setting beats.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace moraine::study {

struct Score {
  double speed = 0;  ///< more is better
  double error = 0;  ///< less is better
};

/// Indices of the scores that no other one equals in both and beats in one; fastest first. Of equals the first stays.
/// Cost: n log n.
std::vector<std::size_t> pareto_front(std::span<const Score> scores);

}  // namespace moraine::study
