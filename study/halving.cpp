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
  const auto ask = [&](int seeds) { return std::clamp(seeds + seeds / 3, std::min(runs + 1, most), most); };
  if (needed.of_setting && *needed.of_setting <= most && runs < most)
    return {Step::Kind::more_seeds, ask(*needed.of_setting)};
  if (needed.of_both && *needed.of_both <= most) return {Step::Kind::more_of_both, ask(*needed.of_both)};
  return {Step::Kind::give_up, runs};
}

std::vector<std::optional<Step::Kind>> first_accepted(std::size_t candidates,
                                                      const std::function<Step::Kind(std::size_t)>& judge,
                                                      const std::function<int()>& evidence) {
  std::vector<std::optional<Step::Kind>> verdicts(candidates);
  for (int known = -1; known < evidence();) {
    known = evidence();
    bool accepted = false;
    for (std::size_t i = 0; i < candidates; ++i) {
      if (verdicts[i] == Step::Kind::reject) continue;
      verdicts[i] = accepted ? std::nullopt : std::optional(judge(i));
      accepted = accepted || verdicts[i] == Step::Kind::accept;
    }
  }
  return verdicts;
}

}  // namespace moraine::study
