// SPDX-License-Identifier: Apache-2.0
#include "output/label.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace moraine {

std::string grouped(std::uint64_t number) {
  std::string digits = fmt::format("{}", number);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, 1, ',');
  return digits;
}

std::string time_label(const TimeSettings& settings, std::int64_t step, double time) {
  if (settings.label.unit.empty()) return fmt::format("{:.6g} s", time);
  return fmt::format("{:.6g} {}", settings.label.per_step * static_cast<double>(step), settings.label.unit);
}

std::string duration_label(double seconds) {
  if (!std::isfinite(seconds)) return "unknown";
  const auto whole = static_cast<std::int64_t>(std::llround(std::clamp(seconds, 0.0, 1e9)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace moraine
