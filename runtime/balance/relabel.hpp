// SPDX-License-Identifier: Apache-2.0
// Which rank gets which part of a plan made without regard to present owners.
#pragma once

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

/// Exchanges ranks of the same speed and memory in `plan` so that many bytes stay where they are: the part and rank
/// that share most bytes are matched first (Oliker & Biswas 1998, J. Parallel Distrib. Comput. 52: what stays is at
/// least half of what could). Times of ranks are only exchanged. Cost: O(sub-models log sub-models + ranks log ranks).
Owners relabel(const BalanceProblem& problem, const Owners& plan);

}  // namespace moraine::runtime
