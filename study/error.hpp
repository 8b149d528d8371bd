// SPDX-License-Identifier: Apache-2.0
// How far a setting's results are from the reference, and what the seeds allow to say about it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/statistics.hpp"

namespace moraine::study {

/// One observable of a setting and of the reference. A deviation of `scale` is an error of 1.
struct Comparison {
  std::string observable;
  Sample measured, reference;
  double scale = 1;
};

/// Deviation of the means and half its 95 % interval, relative to the scale.
struct Deviation {
  double value = 0;
  double uncertainty = 0;
};
Deviation deviation(const Comparison& comparison);

/// Of a setting: its worst observable's.
struct Error {
  double value = 0;   ///< largest deviation
  double low = 0;     ///< it is at least so much, and
  double high = 0;    ///< at most so much
  std::string worst;  ///< observable
  /// The error, or its uncertainty if that is more: what is distinguishable from the reference. Of single runs, whose
  /// uncertainty is not known, the error.
  double resolved() const { return std::isfinite(high) ? std::max(value, high - value) : value; }
};
Error error_of(std::span<const Comparison> comparisons);

enum class Verdict { below, above, undecided };
Verdict judge(const Error& error, double wish);

/// Seeds that would decide whether the error is below `wish`, for the worst undecided observable.
struct SeedsNeeded {
  std::optional<int> of_setting;  ///< with the reference as it is
  std::optional<int> of_both;     ///< of the setting and the reference each
};
SeedsNeeded seeds_to_decide(std::span<const Comparison> comparisons, double wish);

}  // namespace moraine::study
