// SPDX-License-Identifier: Apache-2.0
// What a sub-model will cost, from what it did cost: busy seconds or counted work.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace moraine::runtime {

/// A sub-model's last epochs. Goes with it to other ranks and into checkpoints.
class LoadHistory {
 public:
  static constexpr std::size_t kept = 5;
  static constexpr std::size_t saved_bytes = (kept + 1) * sizeof(double);

  /// Mean load of an epoch's rounds. Errors: std::invalid_argument if negative or not finite.
  void add(double load);
  /// Oldest first, `kept` at most.
  std::span<const double> loads() const { return loads_; }

  /// Appends `saved_bytes` bytes.
  void save(std::vector<std::byte>& out) const;
  /// Errors: std::invalid_argument unless `in` is what save() appended; then nothing changes.
  void load(std::span<const std::byte> in);

 private:
  std::vector<double> loads_;
};

/// The next epoch's load from those of earlier ones, oldest first; never negative; 0 if there are none.
struct PredictorRow {
  std::string_view name;
  std::string_view help;  ///< one line
  double (*predict)(std::span<const double> loads);
};

std::span<const PredictorRow> predictors();

/// Errors: std::invalid_argument, listing the table, if there is none of that name.
const PredictorRow& find_predictor(std::string_view name);

}  // namespace moraine::runtime
