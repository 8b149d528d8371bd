// SPDX-License-Identifier: Apache-2.0
#include "study/error.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::study {
namespace {

/// The larger; nothing is larger than any number.
std::optional<int> more(std::optional<int> a, std::optional<int> b) {
  return a && b ? std::optional(std::max(*a, *b)) : std::nullopt;
}

bool undecided(const Deviation& d, double wish) {
  return std::abs(d.value) - d.uncertainty <= wish && std::abs(d.value) + d.uncertainty > wish;
}

}  // namespace

Deviation deviation(const Comparison& c) {
  const Difference d = difference(c.measured, c.reference);
  return {d.value / c.scale, d.uncertainty / c.scale};
}

Error error_of(std::span<const Comparison> comparisons) {
  Error e;
  for (const Comparison& c : comparisons) {
    const Deviation d = deviation(c);
    const double size = std::abs(d.value);
    if (e.worst.empty() || size > e.value) e.worst = c.observable;
    e.value = std::max(e.value, size);
    e.low = std::max(e.low, size - d.uncertainty);
    e.high = std::max(e.high, size + d.uncertainty);
  }
  return e;
}

Verdict judge(const Error& error, double wish) {
  if (error.high <= wish) return Verdict::below;
  return error.low > wish ? Verdict::above : Verdict::undecided;
}

SeedsNeeded seeds_to_decide(std::span<const Comparison> comparisons, double wish) {
  SeedsNeeded needed{1, 1};
  for (const Comparison& c : comparisons) {
    const Deviation d = deviation(c);
    if (!undecided(d, wish)) continue;
    const double margin = std::abs(wish - std::abs(d.value)) * c.scale;
    needed.of_setting = more(needed.of_setting, runs_needed(c.measured, c.reference, margin, false));
    needed.of_both = more(needed.of_both, runs_needed(c.measured, c.reference, margin, true));
  }
  return needed;
}

}  // namespace moraine::study
