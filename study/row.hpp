// SPDX-License-Identifier: Apache-2.0
// A setting with what its runs amount to.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/subject.hpp"
#include "study/yardstick.hpp"

namespace moraine::study {

/// Whose seconds speeds are stated in: those of the wall, or the processor's, which other programs disturb less.
enum class Seconds { wall, processor };

inline constexpr const char* seeds_change_nothing =
    "its seeds change nothing, all runs end in the same state; expected a perturbation, or a parameter under "
    "tradeoff.seed that the scene depends on, or --seeds 1";

struct Row {
  Setting setting;
  std::string command;              ///< with the first seed
  int seeds = 0;                    ///< runs made
  int status = 0;                   ///< of the first run that failed
  std::string reason;               ///< why
  double wall_s = 0, cpu_s = 0;     ///< of the steps, medians over seeds
  double speed = 0;                 ///< simulated seconds per second
  std::vector<Comparison> all;      ///< every observable
  std::vector<Comparison> counted;  ///< those that make the error
  Error error;                      ///< of a good row

  bool good() const { return status == 0; }
};

/// Whether several runs end in the very same state: then their seeds change nothing, and say nothing about spread.
bool alike(std::span<const Record> runs);

/// A row fails if any of its runs did, or if its seeds change nothing.
Row make_row(const Setting& setting, std::span<const Record> runs, const Yardstick& yardstick, Seconds seconds);

/// The good rows that no other beats in both speed and resolved error; fastest first.
std::vector<std::size_t> front_of(std::span<const Row> rows);

/// The fastest good row with this verdict on `wish`.
std::optional<std::size_t> fastest(std::span<const Row> rows, double wish, Verdict verdict);

}  // namespace moraine::study
