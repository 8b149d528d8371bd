// SPDX-License-Identifier: Apache-2.0
#include "ghosting/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace moraine {
namespace {

constexpr std::int64_t fewest_rounds = 8, most_rounds = 64;
constexpr double margin_diameters = 2;

/// Farthest that anything may travel in `rounds`.
double travel(double speed, double gravity, double substep, std::int64_t rounds) {
  const double t = static_cast<double>(rounds) * substep;
  return 2 * speed * t + gravity * t * t / 2;
}

int widest_axis(std::span<const Reach> reaches) {
  const Bounds all = all_of(reaches);
  int axis = 0;
  (all.max - all.min).maxCoeff(&axis);
  return axis;
}

/// Ascending. Sweeps along the longest axis: those that are far apart there are never compared.
std::vector<std::pair<SubModelId, SubModelId>> pairs_within(std::span<const Reach> reaches, double margin) {
  const int axis = widest_axis(reaches);
  const auto bounds = [&](SubModelId id) -> const Bounds& { return reaches[id].bounds; };
  std::vector<SubModelId> order(reaches.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](SubModelId a, SubModelId b) { return bounds(a).min[axis] < bounds(b).min[axis]; });
  std::vector<std::pair<SubModelId, SubModelId>> pairs;
  for (auto first = order.begin(); first != order.end(); ++first) {
    const double end = bounds(*first).max[axis] + 2 * margin;  // more than enough, whatever rounding does
    for (auto other = first + 1; other != order.end() && bounds(*other).min[axis] <= end; ++other) {
      const auto [a, b] = std::minmax(*first, *other);
      if (bounds(a).inflated(margin).overlaps(bounds(b))) pairs.emplace_back(a, b);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

Bounds all_of(std::span<const Reach> reaches) {
  Bounds all;
  for (const Reach& r : reaches)
    if (!r.bounds.empty()) all.add(r.bounds);
  return all;
}

Neighbourhood find_neighbours(std::span<const Reach> reaches, double driven, double diameter, double gravity,
                              double substep, std::int64_t at_most) {
  double speed = driven;
  for (const Reach& r : reaches) speed = std::max(speed, r.max_speed);
  const std::int64_t wish = std::min(most_rounds, at_most);
  Neighbourhood out;
  out.rounds = std::min(fewest_rounds, at_most);
  while (out.rounds < wish && travel(speed, gravity, substep, out.rounds + 1) <= margin_diameters / 2 * diameter)
    ++out.rounds;
  const double margin = std::max(margin_diameters * diameter, 2 * travel(speed, gravity, substep, out.rounds));
  out.pairs = pairs_within(reaches, margin);
  return out;
}

}  // namespace moraine
