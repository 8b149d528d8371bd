// SPDX-License-Identifier: Apache-2.0
// Pixels, row after row from the top left.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace moraine {

using Rgb = std::array<std::uint8_t, 3>;

/// White to begin with.
struct Image {
  Image(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, Rgb{255, 255, 255}) {}
  Rgb& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const Rgb& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }

  int width, height;
  std::vector<Rgb> pixels;
};

}  // namespace moraine
