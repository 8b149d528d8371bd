// SPDX-License-Identifier: Apache-2.0
// Reads a scene from YAML.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "physics/scene/scene.hpp"

namespace moraine {

/// One `--set name=value` or `--set key.path=value`, with where it came from for error texts ("--set",
/// "MORAINE_THREADS").
struct Override {
  std::string key;
  std::string value;
  std::string origin = "--set";
};

/// Reads `file`, applies the overrides in order (a bare name that the scene declares under `parameters` sets that
/// parameter; anything else is a dotted path into the document, list items by index), evaluates expressions, builds
/// packings and bonds. Paths inside the scene are relative to the scene file.
/// Errors: InputError `file:line:column: what is wrong, what was expected`; never a default instead of a wrong value.
/// Cost: linear in elements (packings, touching-pair search by cells).
Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

}  // namespace moraine
