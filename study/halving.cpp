// SPDX-License-Identifier: Apache-2.0
#include "study/halving.hpp"

#include <algorithm>

namespace moraine::study {

std::vector<std::size_t> plausible(std::span<const Candidate> candidates, double wish) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].good && judge(candidates[i].error, wish) != Verdict::above) kept.push_back(i);
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return candidates[a].cost < candidates[b].cost; });
  return kept;
}

std::size_t half_of(std::size_t count, std::size_t least) { return std::min(count, std::max((count + 1) / 2, least)); }

Step next_step(std::span<const Comparison> comparisons, double wish, int runs, int enough, int most) {
  const Verdict verdict = judge(error_of(comparisons), wish);
  if (verdict == Verdict::above) return {Step::Kind::reject, runs};
  if (runs < enough) return {Step::Kind::more_seeds, enough};
  if (verdict == Verdict::below) return {Step::Kind::accept, runs};
  const SeedsNeeded needed = seeds_to_decide(comparisons, wish);
  // Spreads are estimates: each time a third more than they ask for.
  const auto ask = [&](int seeds) { return std::max(runs + 1, seeds + seeds / 3); };
  if (needed.of_setting && ask(*needed.of_setting) <= most) return {Step::Kind::more_seeds, ask(*needed.of_setting)};
  if (needed.of_both && ask(*needed.of_both) <= most) return {Step::Kind::more_of_both, ask(*needed.of_both)};
  return {Step::Kind::give_up, runs};
}

}  // namespace moraine::study
