// SPDX-License-Identifier: Apache-2.0
// Who owns what before anything has run.
#pragma once

#include <span>

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

/// One block of successive sub-models per rank, in the order of ranks, with the least makespan blocks can have; numbers
/// run along the split, so neighbours stay together. No rank is left without if there are enough sub-models. `load`:
/// per sub-model, predicted; taken as equal if none is positive. `speed`: per rank, positive. The makespan is found by
/// bisection, ranks being filled in turn (Pinar & Aykanat 2004, J. Parallel Distrib. Comput. 64, "probe"). Cost: O(64 *
/// sub-models).
Owners initial_owners(std::span<const double> load, std::span<const double> speed);

}  // namespace moraine::runtime
