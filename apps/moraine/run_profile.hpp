// SPDX-License-Identifier: Apache-2.0
// Where the time of a run went that need not have been traced.
#pragma once

#include "output/summary.hpp"
#include "runtime/simulation.hpp"

namespace moraine::app {

/// Collective; complete on rank 0. Cost: there, some 20 replays of 20,000 tasks, unless workers hardly waited.
Summary::Profile profile_of(runtime::Simulation& simulation);

}  // namespace moraine::app
