// SPDX-License-Identifier: Apache-2.0
// Guards: what is looked at between epochs, so that a run that goes wrong says so early, and stops when its result
// means nothing any more.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ghosting/accounts.hpp"
#include "ghosting/report.hpp"
#include "ghosting/sub_model.hpp"

namespace moraine {

/// The whole model between two epochs, the same on every rank.
struct Watch {
  const ModelContext& context;
  Extremes extremes;
  const Accounts& accounts;
  double linear_residual = 0, angular_residual = 0;  ///< as in ModelStatistics
  double disagreement = 0;  ///< rms speed by which copies disagreed since the last look / sqrt(g d)
  double overlap = 0;       ///< at the end of the run, as in OverlapStatistics; else 0
};

/// A row of the table: one number, and from where on it is too large. Steps are checked for speed and for numbers that
/// are not finite as well, in every substep (SubModel::check_motions).
struct Guard {
  std::string_view name;
  std::string_view help;
  double warns = std::numeric_limits<double>::infinity();
  double stops = std::numeric_limits<double>::infinity();
  Worst (*look)(const Watch&);  ///< the element is of no account for numbers of the whole model
  /// What is wrong where, and which setting to change.
  std::string (*text)(const ModelContext&, const Worst&, std::int64_t step);
};

std::span<const Guard> guards();

/// What guards have seen in a run so far. Kept alike on all ranks, and saved.
class GuardLog {
 public:
  struct Entry {
    std::uint64_t count = 0;  ///< looks that found the number too large
    Worst first, worst;
    std::int64_t first_step = 0, worst_step = 0;
  };

  GuardLog() : entries(guards().size()) {}
  /// Errors: InvalidStateError if a guard stops the run. Cost: a few operations per guard.
  void look(const Watch& watch, std::int64_t step);
  /// One for each guard that warned, with how often and the worst it saw.
  std::vector<std::string> warnings(const ModelContext& context) const;
  /// Texts of the guards that warned for the first time since this was called last.
  std::vector<std::string> take_news() { return std::exchange(news_, {}); }

  /// Rms speed by which copies disagreed since this was asked last [m/s].
  double disagreement_since(const Accounts& accounts, const std::vector<Report>& reports);

  std::vector<Entry> entries;  ///< one per guard
  std::uint64_t looks = 0;
  double disagreement = 0;  ///< of the whole run until the last look, as in Accounts
  std::uint64_t disagreements = 0;

 private:
  std::vector<std::string> news_;
};

}  // namespace moraine
