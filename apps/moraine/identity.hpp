// SPDX-License-Identifier: Apache-2.0
// What is computed, in 16 hex digits: a checkpoint fits the run that has the same.
#pragma once

#include <string>

#include "physics/scene/scene.hpp"

namespace moraine::app {

/// XXH3-64 over the scene and all settings that change results. Not over the number of steps, threads, ranks, names,
/// output.
std::string identity(const Scene& scene);

}  // namespace moraine::app
