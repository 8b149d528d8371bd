// SPDX-License-Identifier: Apache-2.0
// Small upright letters for captions: printable ASCII, 5 by 7 dots.
#pragma once

#include <string_view>

#include "output/picture/image.hpp"

namespace moraine {

/// Draws from the top left corner, each dot `size` pixels wide; anything beyond ASCII shows as '?'. Parts outside of
/// the image are left out.
void draw_text(Image& image, int x, int y, std::string_view text, int size, Rgb colour);

/// Width [pixels].
int text_width(std::string_view text, int size);

}  // namespace moraine
