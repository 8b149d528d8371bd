// SPDX-License-Identifier: Apache-2.0
// What the subcommands do. Each returns the exit status.
#pragma once

#include <filesystem>

#include "physics/scene/scene.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::app {

/// Called on all ranks.
int run(const Scene& scene, runtime::Transport& transport);
/// `ranks`: that would share the scene.
int info(const Scene& scene, int ranks);
int list();
int render(const std::filesystem::path& folder, int width);

}  // namespace moraine::app
