// SPDX-License-Identifier: Apache-2.0
// How the files of a frame are called.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace moraine {

/// The folder, below that of the run, with a file or more per frame.
inline constexpr const char* kFrames = "frames";

/// "elements_000120.vtu" for group "elements", step 120, extension "vtu".
inline std::string frame_name(const char* group, std::int64_t step, const char* extension) {
  return fmt::format("{}_{:06}.{}", group, step, extension);
}

}  // namespace moraine
