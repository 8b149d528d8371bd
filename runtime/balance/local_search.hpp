// SPDX-License-Identifier: Apache-2.0
// Better owners by few moves and swaps.
#pragma once

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

/// Starts from `owners` and takes steps until none helps or the makespan is within 2 % of an even spread. A step moves
/// a sub-model of the rank that takes longest, or swaps it for another rank's, so that the longer of both ranks takes
/// less time than the longest did. Of steps that help equally, to 1 % of an even spread, the one with the least bytes
/// sent between ranks until the next turn is taken, moves included. The makespan never rises. A rank never gets more
/// than its memory holds.
/// Cost: each step O(own sub-models * all sub-models).
Owners local_search(const BalanceProblem& problem, const Owners& owners);

}  // namespace moraine::runtime
