// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/initial_owners.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace moraine::runtime {
namespace {

constexpr int halvings = 64;  // more than a double has bits

struct Blocks {
  Owners owners;
  bool in_time = true;
};

/// Fills ranks in turn, none for longer than `makespan`, but the last, which gets what is left. If `spread`, ranks are
/// left early for the later ones to get one each.
Blocks fill(std::span<const double> load, std::span<const double> speed, double makespan, bool spread) {
  Blocks blocks;
  std::size_t rank = 0;
  double own = 0;
  for (std::size_t s = 0; s < load.size(); ++s) {
    const auto is_full = [&] { return own + load[s] > makespan * speed[rank]; };
    const std::size_t later = speed.size() - 1 - rank;
    bool leave = spread && s > 0 && load.size() - s <= later;
    while (rank + 1 < speed.size() && (leave || is_full())) {
      ++rank;
      own = 0;
      leave = false;
    }
    blocks.in_time = blocks.in_time && !is_full();
    own += load[s];
    blocks.owners.push_back(static_cast<int>(rank));
  }
  return blocks;
}

double least_makespan(std::span<const double> load, std::span<const double> speed) {
  const double total = std::accumulate(load.begin(), load.end(), 0.0);
  double low = total / std::accumulate(speed.begin(), speed.end(), 0.0);
  double high = 2 * total / *std::max_element(speed.begin(), speed.end());
  for (int i = 0; i < halvings; ++i) {
    const double middle = low + (high - low) / 2;
    (fill(load, speed, middle, false).in_time ? high : low) = middle;
  }
  return high;
}

}  // namespace

Owners initial_owners(std::span<const double> load, std::span<const double> speed) {
  const bool all_idle = std::all_of(load.begin(), load.end(), [](double l) { return l <= 0; });
  const std::vector<double> equal(load.size(), 1.0);
  const std::span<const double> work = all_idle ? std::span(equal) : load;
  const double makespan = least_makespan(work, speed);
  const Blocks spread = fill(work, speed, makespan, true);
  return spread.in_time ? spread.owners : fill(work, speed, makespan, false).owners;
}

}  // namespace moraine::runtime
