// SPDX-License-Identifier: Apache-2.0
// Means over seeds, and how far apart two of them are. All intervals hold in 95 % of cases.
#pragma once

#include <optional>
#include <span>

namespace moraine::study {

/// What runs with different seeds gave for one quantity. `count` 0: the mean is known exactly.
struct Sample {
  int count = 0;
  double mean = 0;
  double deviation = 0;  ///< standard deviation of one run; 0 if there is only one

  double variance() const { return deviation * deviation; }
};

Sample sample_of(std::span<const double> values);
inline Sample exactly(double value) { return {0, value, 0}; }

/// The 97.5 % quantile of Student's t: half of a 95 % interval in standard errors. Infinite below one degree of
/// freedom. Source: tables up to 30 degrees, above by Abramowitz & Stegun (1964), 26.7.5.
double student_t(double degrees);

struct Difference {
  double value = 0;        ///< mean of a less mean of b
  double uncertainty = 0;  ///< half width of its interval; infinite if nothing is known about the spread
};

/// Welch's interval, for samples of different spread. Of a single run it takes the other sample's spread.
/// Source: Welch (1947).
Difference difference(const Sample& a, const Sample& b);

/// Runs of `a` that would make the uncertainty at most `margin`, if the spreads stay as they are; with `both`, runs of
/// each. A single run has the spread of the other sample. Nothing if no number below 100,000 would, or if no spread is
/// known.
std::optional<int> runs_needed(Sample a, Sample b, double margin, bool both);

}  // namespace moraine::study
