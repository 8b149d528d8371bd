// SPDX-License-Identifier: Apache-2.0
// Decisions of the search for the cheapest setting that is good enough. Source: successive halving, Jamieson &
// Talwalkar (2016), with cost as the loss: candidates are dropped when they are surely too bad, and of those that may
// be good enough the cheaper half is looked at more closely.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "study/error.hpp"

namespace moraine::study {

struct Candidate {
  double cost = 0;   ///< seconds per simulated second
  bool good = true;  ///< none of its runs failed
  Error error;
};

/// Indices of the candidates that are not surely worse than `wish`; cheapest first.
std::vector<std::size_t> plausible(std::span<const Candidate> candidates, double wish);

/// How many of so many to look at more closely: the half, but `least` if there are so many.
std::size_t half_of(std::size_t count, std::size_t least);

/// What to do with a candidate that has been run with `runs` seeds, at most `most`.
struct Step {
  enum class Kind { accept, reject, more_seeds, more_of_both, give_up } kind = Kind::accept;
  int seeds = 0;  ///< to reach, if more
};
/// Accepts and rejects what is sure. Else asks for as many seeds as should decide, at least `enough`; gives up if more
/// than `most` would be needed.
Step next_step(std::span<const Comparison> comparisons, double wish, int runs, int enough, int most);

/// The verdict on each of so many candidates, the cheapest first, up to the first that is accepted. `judge(i)` may
/// gather evidence that all are judged by, which raises `evidence()`: then all but the rejected are judged again, as it
/// may decide what was undecided. Those after the accepted one have none.
std::vector<std::optional<Step::Kind>> first_accepted(std::size_t candidates,
                                                      const std::function<Step::Kind(std::size_t)>& judge,
                                                      const std::function<int()>& evidence);

}  // namespace moraine::study
