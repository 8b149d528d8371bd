// SPDX-License-Identifier: Apache-2.0
// Portable Network Graphics, by libpng.
#pragma once

#include <filesystem>

#include "output/picture/image.hpp"

namespace moraine {

/// Replaces `path` in one move. Errors: IoError naming the path.
void write_png(const Image& image, const std::filesystem::path& path);

/// Reads any PNG as RGB. Errors: IoError naming the path.
Image read_png(const std::filesystem::path& path);

}  // namespace moraine
