// SPDX-License-Identifier: Apache-2.0
// The part of a scene that pictures need, kept beside the frames so that a run can be drawn without its scene file.
#pragma once

#include <filesystem>
#include <string>

#include "physics/scene/scene.hpp"

namespace moraine {

/// Writes folder/shapes.json: name, gravity, time label, shapes, boundaries. Errors: IoError naming the path.
void write_scene_table(const Scene& scene, const std::filesystem::path& folder);

/// Equal for scenes with equal shapes and boundaries, motions not regarded.
std::string geometry_text(const Scene& scene);

/// A scene with those members only; no elements, materials or bonds. Errors: IoError naming the path.
Scene read_scene_table(const std::filesystem::path& folder);

}  // namespace moraine
