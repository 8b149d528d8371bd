// SPDX-License-Identifier: Apache-2.0
// What the subcommands do. Each returns the exit status.
#pragma once

#include <filesystem>

#include "physics/scene/scene.hpp"

namespace moraine::app {

int run(const Scene& scene);
int info(const Scene& scene);
int list();
int render(const std::filesystem::path& folder, int width);

}  // namespace moraine::app
