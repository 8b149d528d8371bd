// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/load_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace moraine::runtime {
namespace {

/// The number of loads, then the loads, then zeros; whole numbers this small are exact.
using Saved = std::array<double, LoadHistory::kept + 1>;
static_assert(sizeof(Saved) == LoadHistory::saved_bytes);

bool is_load(double value) { return std::isfinite(value) && value >= 0; }

bool is_valid(const Saved& saved) {
  return is_load(saved[0]) && saved[0] <= LoadHistory::kept && saved[0] == std::floor(saved[0]) &&
         std::all_of(saved.begin() + 1, saved.end(), is_load);
}

double last(std::span<const double> loads) { return loads.empty() ? 0.0 : loads.back(); }

double median(std::span<const double> loads) {
  if (loads.empty()) return 0;
  std::vector<double> sorted(loads.begin(), loads.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

/// The straight line with least squares through loads at times 0 ... n - 1, at time n.
double trend(std::span<const double> loads) {
  if (loads.size() < 2) return last(loads);
  const auto n = static_cast<double>(loads.size());
  double sum = 0, moment = 0;  // of loads, about the mean time (n - 1) / 2
  for (std::size_t i = 0; i < loads.size(); ++i) {
    sum += loads[i];
    moment += (static_cast<double>(i) - (n - 1) / 2) * loads[i];
  }
  const double slope = moment * 12 / (n * (n * n - 1));
  return std::max(0.0, sum / n + slope * (n + 1) / 2);
}

constexpr std::array table{
    PredictorRow{"last", "as in the last epoch", last},
    PredictorRow{"median", "the median of the last five epochs: single slow ones do not count", median},
    PredictorRow{"trend", "a straight line through the last five epochs", trend},
};

}  // namespace

void LoadHistory::add(double load) {
  if (!is_load(load)) throw std::invalid_argument(fmt::format("load {} is negative or not finite", load));
  if (loads_.size() == kept) loads_.erase(loads_.begin());
  loads_.push_back(load);
}

void LoadHistory::save(std::vector<std::byte>& out) const {
  Saved saved{static_cast<double>(loads_.size())};
  std::copy(loads_.begin(), loads_.end(), saved.begin() + 1);
  const auto bytes = std::as_bytes(std::span(saved));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void LoadHistory::load(std::span<const std::byte> in) {
  Saved saved{};
  if (in.size() != saved_bytes) throw std::invalid_argument("saved load history has the wrong size");
  std::memcpy(saved.data(), in.data(), saved_bytes);
  if (!is_valid(saved)) throw std::invalid_argument("saved load history is damaged");
  loads_.assign(saved.begin() + 1, saved.begin() + 1 + static_cast<std::ptrdiff_t>(saved[0]));
}

std::span<const PredictorRow> predictors() { return table; }

const PredictorRow& find_predictor(std::string_view name) {
  std::string known;
  for (const PredictorRow& row : table) {
    if (row.name == name) return row;
    known += fmt::format("\n  {:<14} {}", row.name, row.help);
  }
  throw std::invalid_argument(fmt::format("no load predictor is called '{}'; there are:{}", name, known));
}

}  // namespace moraine::runtime
