// SPDX-License-Identifier: Apache-2.0
// Triangle meshes from STL and OBJ files.
#pragma once

#include <filesystem>

#include "physics/scene/scene.hpp"

namespace moraine {

/// All triangles of the file, equal corners merged. Coordinates are read in single precision, in metres.
/// Errors: InputError naming the file.
TriangleMesh read_mesh(const std::filesystem::path& file);

}  // namespace moraine
