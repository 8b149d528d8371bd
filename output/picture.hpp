// SPDX-License-Identifier: Apache-2.0
// A frame as a picture, drawn without a display.
#pragma once

#include <filesystem>

#include "output/frame.hpp"
#include "output/picture/image.hpp"

namespace moraine {

/// Two views from above, of one camera: elements coloured by sub-model over ghosts coloured by their host; meshes and
/// solids of the boundaries as lines; name, step, time and counts as captions. The same frame gives the same pixels.
/// `width` [pixels] is at least 200. Cost: a second for 100,000 spheres at 1200 pixels.
Image draw_picture(const Scene& scene, const Frame& frame, int width);

/// draw_picture as PNG. Errors: IoError naming the path.
void write_picture(const Scene& scene, const Frame& frame, const std::filesystem::path& path, int width);

}  // namespace moraine
