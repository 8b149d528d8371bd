// SPDX-License-Identifier: Apache-2.0
#include "study/pareto.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace moraine::study {

std::vector<std::size_t> pareto_front(std::span<const Score> scores) {
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return scores[a].speed != scores[b].speed ? scores[a].speed > scores[b].speed : scores[a].error < scores[b].error;
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (!(scores[i].error < least)) continue;
    least = scores[i].error;
    front.push_back(i);
  }
  return front;
}

}  // namespace moraine::study
