// SPDX-License-Identifier: Apache-2.0
// The search for the cheapest setting that is good enough.
#pragma once

#include <optional>
#include <vector>

#include "study/laboratory.hpp"
#include "study/row.hpp"

namespace moraine::study {

struct TuningOptions {
  double wish = 0.01;  ///< largest error
  int seeds = 3;       ///< of the reference, and of candidates that are looked at closely
  int first_seed = 1;
  int fresh_seeds = 5;      ///< that a candidate is judged by, at least; none was used to choose it
  int most_seeds = 12;      ///< of a candidate or the reference
  double slack = 1.5;       ///< on the proxy errors may be so many times the wish
  bool proxy_only = false;  ///< the scene is too large to be run even with the reference
  Seconds seconds = Seconds::wall;
};

struct Tuned {
  std::size_t candidates = 0;
  std::size_t failed = 0;        ///< on the proxy
  std::size_t refuted = 0;       ///< surely too bad on the proxy
  std::vector<Row> too_bad;      ///< surely, by fresh seeds
  std::vector<Row> undecided;    ///< after as many seeds as are allowed
  std::optional<Row> found;      ///< surely good enough, by fresh seeds; the cheapest of those tried
  std::optional<Row> reference;  ///< of the scene that candidates were judged on
  std::optional<double> noise;   ///< as Yardstick::noise()
  bool on_proxy = false;         ///< candidates were judged on the proxy
};

/// Screens all settings of the grid on the proxy, with one seed and then, the cheaper half, with `seeds`; judges the
/// remaining ones on the scene itself with fresh seeds, cheapest first, and stops at the first that is good enough.
/// Errors: InputError if the reference fails.
Tuned tune(const Subject& subject, const std::vector<AxisBlock>& grid, Laboratory& laboratory,
           const TuningOptions& options);

/// Runs of the reference with these seeds; none if all that counts is expected.
std::vector<Record> run_reference(const Subject& subject, Laboratory& laboratory, int first_seed, int seeds);

/// A setting with seeds counting up from the first.
std::vector<Trial> trials_of(const Setting& setting, int first_seed, int seeds);

}  // namespace moraine::study
