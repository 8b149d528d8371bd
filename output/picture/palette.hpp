// SPDX-License-Identifier: Apache-2.0
// One colour per sub-model.
#pragma once

#include <cstdint>

#include "output/picture/image.hpp"

namespace moraine {

/// Fourteen chosen colours, then hues a golden angle apart. The same number always has the same colour.
Rgb palette(std::uint32_t number);

}  // namespace moraine
