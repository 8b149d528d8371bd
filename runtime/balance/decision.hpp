// SPDX-License-Identifier: Apache-2.0
// Whether a plan is worth the moves it takes.
#pragma once

#include <span>

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

double sum(std::span<const double> values);

/// What a round is predicted to be like under some owners.
struct Forecast {
  double makespan = 0;   ///< time of the rank that takes longest: load / speed
  double imbalance = 1;  ///< makespan / what it would be if work could be spread at will; 1 if there is no work
  double cut_bytes = 0;  ///< sent between ranks
};

/// Cost: O(sub-models + ranks + traffic).
Forecast forecast(const BalanceProblem& problem, const Owners& owners);

/// True if no rank owns more bytes than it may.
bool fits_memory(const BalanceProblem& problem, const Owners& owners);

struct BalanceDecision {
  Owners plan;              ///< as proposed
  bool worthwhile = false;  ///< carry it out
  Forecast before;
  Forecast after;
  std::int64_t moves = 0;
  double bytes = 0;         ///< moved
  double gain_seconds = 0;  ///< over the costs' rounds
  double cost_seconds = 0;  ///< of the rank with most to send and receive; ranks move at the same time
};

/// What moves cost a run that looks at owners every so many rounds, with load measured in seconds or counted. Saving,
/// sending and loading a sub-model was measured on one machine: about 1 GB/s, and a quarter of a millisecond.
BalanceCosts costs_of(bool measured, std::int64_t every);

/// Asks the balancer and judges its plan. A forced plan is worthwhile if it moves anything. Others must gain more time
/// than they cost, lower the imbalance by more than the least gain, and not exceed the memory of ranks.
/// Errors: std::invalid_argument if problem or plan are malformed.
BalanceDecision decide(const BalanceProblem& problem, const Balancer& balancer, bool forced);

}  // namespace moraine::runtime
