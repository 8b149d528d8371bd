// SPDX-License-Identifier: Apache-2.0
#include "ghosting/auto_count.hpp"

#include <algorithm>
#include <cmath>

namespace moraine {
namespace {

// Sub-models that are mostly surface couple their elements badly, however cheap they are.
constexpr double most_ghosts = 1.0 / 3;

}  // namespace

double expected_ghost_share(double elements) { return 3.0 / std::cbrt(std::max(elements, 1.0)); }

double cheapest_size(const Engine& engine) {
  double best = 0, least = HUGE_VAL;
  for (double n = 1; n <= 200'000; n *= 1.05) {
    const double share = expected_ghost_share(n);
    if (share > most_ghosts) continue;
    const double cost = engine.relative_cost(n * (1 + share)) * (1 + share);
    if (cost < least) {
      least = cost;
      best = n;
    }
  }
  return best;
}

std::size_t auto_count(std::size_t elements, const Engine& engine, const Limits& limits) {
  const auto n = static_cast<double>(elements);
  const double by_cost = std::round(n / cheapest_size(engine));
  const double capacity = static_cast<double>(limits.packed_spheres()) * (1 - limits.ghost_reserve);
  const double by_limit = std::ceil(n / capacity);
  return static_cast<std::size_t>(std::max({1.0, by_cost, by_limit}));
}

}  // namespace moraine
