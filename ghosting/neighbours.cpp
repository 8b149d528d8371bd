// SPDX-License-Identifier: Apache-2.0
#include "ghosting/neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace moraine {
namespace {

constexpr std::int64_t fewest_rounds = 8, most_rounds = 64;
constexpr double margin_diameters = 2;

/// Farthest that anything may travel in `rounds`.
double travel(double speed, double gravity, double substep, std::int64_t rounds) {
  const double t = static_cast<double>(rounds) * substep;
  return 2 * speed * t + gravity * t * t / 2;
}

}  // namespace

Neighbourhood find_neighbours(std::span<const Reach> reaches, double diameter, double gravity, double substep,
                              std::int64_t at_most) {
  double speed = 0;
  for (const Reach& r : reaches) speed = std::max(speed, r.max_speed);
  const std::int64_t wish = std::min(most_rounds, at_most);
  Neighbourhood out;
  out.rounds = std::min(fewest_rounds, at_most);
  while (out.rounds < wish && travel(speed, gravity, substep, out.rounds + 1) <= margin_diameters / 2 * diameter)
    ++out.rounds;
  const double margin = std::max(margin_diameters * diameter, 2 * travel(speed, gravity, substep, out.rounds));
  for (SubModelId a = 0; a < reaches.size(); ++a)
    for (SubModelId b = a + 1; b < reaches.size(); ++b)
      if (reaches[a].bounds.inflated(margin).overlaps(reaches[b].bounds)) out.pairs.emplace_back(a, b);
  return out;
}

}  // namespace moraine
