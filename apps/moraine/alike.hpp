// SPDX-License-Identifier: Apache-2.0
// Whether all ranks are about to run the same.
#pragma once

#include "physics/scene/scene.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::app {

/// Ranks read the scene and the environment each for itself, on other machines perhaps another copy of them. What one
/// has otherwise than rank 0 would give other results, or leave ranks waiting for each other. Collective.
/// Errors: InputError, on all ranks, with what differs.
void check_alike(const Scene& scene, runtime::Transport& transport);

}  // namespace moraine::app
