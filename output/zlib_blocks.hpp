// SPDX-License-Identifier: Apache-2.0
// An array as VTK's zlib compressor stores it: block count, block size, size of a partial last block, the compressed
// sizes (all UInt64), then the compressed blocks.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace moraine {

/// Cost: zlib level 1 on blocks of 256 KiB. Errors: IoError if zlib fails.
std::string pack_blocks(std::string_view bytes);

/// The bytes of the array that begins at `offset`. Errors: IoError if it is cut short or damaged.
std::string unpack_blocks(std::string_view packed, std::size_t offset);

}  // namespace moraine
