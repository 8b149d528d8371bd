// SPDX-License-Identifier: Apache-2.0
#include "study/log_axis.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::study {
namespace {

/// Multiples of powers of ten between two logarithms.
std::vector<double> between(double low, double high, const std::vector<int>& multiples) {
  std::vector<double> all;
  for (int power = static_cast<int>(std::floor(low)); power <= high; ++power)
    for (const int m : multiples) {
      const double value = m * std::pow(10.0, power);
      if (std::log10(value) >= low - 1e-9 && std::log10(value) <= high + 1e-9) all.push_back(value);
    }
  return all;
}

}  // namespace

LogAxis::LogAxis(const std::vector<double>& values, double begin, double end)
    : low_(0), high_(0), begin_(begin), end_(end) {
  if (!values.empty()) {
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    low_ = std::log10(*least);
    high_ = std::log10(*greatest);
  }
  const double margin = std::max(0.06 * (high_ - low_), (1 - (high_ - low_)) / 2);
  low_ -= margin;
  high_ += margin;
}

bool LogAxis::holds(double value) const { return value > 0 && std::log10(value) >= low_ && std::log10(value) <= high_; }

double LogAxis::pixel(double value) const {
  const double at = value > 0 ? std::clamp(std::log10(value), low_, high_) : low_;
  return begin_ + (end_ - begin_) * (at - low_) / (high_ - low_);
}

std::vector<double> LogAxis::ticks() const {
  return high_ - low_ > 3 ? between(low_, high_, {1}) : between(low_, high_, {1, 2, 5});
}

std::vector<double> LogAxis::minor_ticks() const { return between(low_, high_, {1, 2, 3, 4, 5, 6, 7, 8, 9}); }

}  // namespace moraine::study
