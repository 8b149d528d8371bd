// SPDX-License-Identifier: Apache-2.0
// Longest processing time first.
#pragma once

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

/// Owners from nothing: the largest sub-model first, each to the rank that would be done with it first among those with
/// memory for it. The makespan is at most 4/3 - 1/(3 ranks) of the least possible one if speeds are equal and memory
/// has no limit (Graham 1969, SIAM J. Appl. Math. 17). Labels are matched to the present owners.
/// Cost: O(sub-models * ranks).
Owners longest_first(const BalanceProblem& problem);

}  // namespace moraine::runtime
