// SPDX-License-Identifier: Apache-2.0
// The parts of a profile that follow chains.
#pragma once

#include "runtime/profile/profile.hpp"

namespace moraine::runtime {

/// Of all epochs, one after another. `elapsed`: of the whole run, in seconds.
CriticalPath critical_path(const Trace& trace, const Chains& chains, double elapsed);

/// Follows the chain of every wait between tasks of a worker, and from its last task to the last of its epoch. Adds to
/// SubModelProfile::awaited.
std::vector<RankWait> who_waited(const Trace& trace, const Chains& chains, std::vector<SubModelProfile>& sub_models);

}  // namespace moraine::runtime
