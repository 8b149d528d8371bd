// SPDX-License-Identifier: Apache-2.0
#include "study/statistics.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace moraine::study {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of the mean; a lone run borrows the spread of the other sample.
double squared_error(const Sample& s, const Sample& other) {
  if (s.count == 0) return 0;
  if (s.count > 1) return s.variance() / s.count;
  return other.count > 1 ? other.variance() : infinity;
}

/// Welch-Satterthwaite, with the errors of the two means squared.
double degrees_of_freedom(const Sample& a, double a2, const Sample& b, double b2) {
  if (a.count < 2) return b.count - 1;
  if (b.count < 2) return a.count - 1;
  const double below = a2 * a2 / (a.count - 1) + b2 * b2 / (b.count - 1);
  return below > 0 ? (a2 + b2) * (a2 + b2) / below : a.count + b.count - 2;
}

}  // namespace

Sample sample_of(std::span<const double> values) {
  Sample s{static_cast<int>(values.size()), 0, 0};
  for (const double v : values) s.mean += v / s.count;
  if (s.count < 2) return s;
  for (const double v : values) s.deviation += (v - s.mean) * (v - s.mean) / (s.count - 1);
  s.deviation = std::sqrt(s.deviation);
  return s;
}

double student_t(double degrees) {
  static constexpr std::array table{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                    2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                    2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  if (!(degrees >= 1)) return infinity;
  const double whole = std::floor(degrees);
  if (whole <= table.size()) return table[static_cast<std::size_t>(whole) - 1];
  constexpr double z = 1.959964;
  const double z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * whole) + (5 * z5 + 16 * z3 + 3 * z) / (96 * whole * whole);
}

Difference difference(const Sample& a, const Sample& b) {
  const double a2 = squared_error(a, b), b2 = squared_error(b, a);
  if (a2 + b2 == 0) return {a.mean - b.mean, 0};
  return {a.mean - b.mean, student_t(degrees_of_freedom(a, a2, b, b2)) * std::sqrt(a2 + b2)};
}

std::optional<int> runs_needed(Sample a, Sample b, double margin, bool both) {
  if (!(margin > 0) || (a.count == 1 && b.count < 2)) return std::nullopt;
  if (a.count == 1) a.deviation = b.deviation;
  if (b.count == 1) b.deviation = a.deviation;
  for (int runs = 2; runs < 100'000; runs += 1 + runs / 50) {
    a.count = runs;
    if (both && b.count > 0) b.count = runs;
    if (difference(a, b).uncertainty <= margin) return runs;
  }
  return std::nullopt;
}

}  // namespace moraine::study
