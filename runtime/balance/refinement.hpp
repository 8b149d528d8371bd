// SPDX-License-Identifier: Apache-2.0
// A local search that cannot end far from the best.
#pragma once

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

/// local_search() from `start`, unless that gets stuck above 4/3 of what no owners can undercut and owners from nothing
/// take less time. With equal speeds and no memory limits the makespan is at most 4/3 of the least possible one,
/// because longest_first()'s is.
Owners refined(const BalanceProblem& problem, const Owners& start);

}  // namespace moraine::runtime
