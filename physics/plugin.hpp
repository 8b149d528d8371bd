// SPDX-License-Identifier: Apache-2.0
// Engines in libraries of their own: for third-party libraries whose symbols must not meet others'.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "physics/world.hpp"

namespace moraine {

/// What an engine's library exports under the name `moraine_make_world`.
using MakeWorld = std::unique_ptr<World> (*)(const WorldSettings&, const Vec3& origin);

/// Where the library of an engine is looked for, in this order: in the folder MORAINE_ENGINES of the environment if it
/// is set; else beside the program, in lib/moraine beside it, and in ../lib/moraine.
std::vector<std::filesystem::path> plugin_places(std::string_view engine);

/// The first of these places that has the library.
std::optional<std::filesystem::path> find_plugin(std::string_view engine);

/// Loads the library `moraine_NAME.so` with all its symbols resolved and kept to itself; it stays until the process
/// ends. Errors: IoError with every place that was looked at, or with what the loader said. Cost: milliseconds; keep
/// it.
MakeWorld load_plugin(std::string_view engine);

}  // namespace moraine
