// SPDX-License-Identifier: Apache-2.0
// What a profile comes down to, in one sentence.
#pragma once

#include <optional>
#include <string>

#include "runtime/profile/account.hpp"
#include "runtime/profile/cure.hpp"

namespace moraine::runtime {

/// The sub-model that others waited for most, or that cost most.
struct Culprit {
  std::uint32_t sub_model = 0;
  double share = 0;         ///< of the waiting for tasks, if traced; else of the work
  double times_median = 1;  ///< its cost in terms of the median sub-model's
  bool traced = false;
};

/// None if nothing stands out: less than twice the median's cost and less than half of the waiting.
std::optional<Culprit> culprit_of(std::span<const double> seconds, std::span<const double> awaited);

/// What to do and what it would gain, a share of the run time.
struct Advice {
  std::string words;
  double gain = 0;
  bool changes_results = false;
};
std::optional<Advice> advice_of(const Cures& cures, const Workload& work);

/// "11.3 % of the run time was spent waiting: 8.1 % imbalance, 2.0 % messages, 1.2 % scheduling; the cure most likely
/// to help is --balancer refine: 7.4 % less time."
std::string sentence(const Account& all, const std::optional<Culprit>& culprit, const std::optional<Advice>& advice);

}  // namespace moraine::runtime
