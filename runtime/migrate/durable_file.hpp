// SPDX-License-Identifier: Apache-2.0
// Files that are complete or absent, also after the machine has stopped.
#pragma once

#include <filesystem>

#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// Errors of all three: std::system_error naming the path.
Bytes read_file(const std::filesystem::path& path);
/// Under another name first; on disk when this returns.
void write_durably(const std::filesystem::path& path, const Bytes& bytes);
/// Replaces what is at `to`. On disk when this returns.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace moraine::runtime
