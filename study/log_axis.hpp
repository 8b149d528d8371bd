// SPDX-License-Identifier: Apache-2.0
// A logarithmic axis of a plot.
#pragma once

#include <string>
#include <vector>

namespace moraine::study {

class LogAxis {
 public:
  /// From the least to the greatest value, widened a little and to at least a decade, on pixels from `begin` to `end`.
  /// Values are positive.
  LogAxis(const std::vector<double>& values, double begin, double end);

  /// Whether the axis reaches so far.
  bool holds(double value) const;
  /// Values outside are moved to the nearer end.
  double pixel(double value) const;
  /// Values 1, 2 and 5 times powers of ten; of more than three decades the powers only.
  std::vector<double> ticks() const;
  /// Those between two ticks, without labels.
  std::vector<double> minor_ticks() const;

 private:
  double low_, high_;  ///< log10
  double begin_, end_;
};

}  // namespace moraine::study
