// SPDX-License-Identifier: Apache-2.0
#include "output/zlib_blocks.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "physics/errors.hpp"

namespace moraine {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;
constexpr std::size_t kWord = sizeof(std::uint64_t);

std::string pack_block(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_SPEED);
  if (status != Z_OK) throw IoError("zlib could not compress an array");
  packed.resize(size);
  return packed;
}

void unpack_block(std::string_view packed, std::string& bytes, std::size_t size) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + size);
  uLongf written = size;
  const int status = uncompress(reinterpret_cast<Bytef*>(bytes.data() + begin), &written,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (status != Z_OK || written != size) throw IoError("a compressed array is damaged");
}

std::uint64_t word_at(std::string_view packed, std::size_t offset) {
  if (packed.size() < kWord || offset > packed.size() - kWord) throw IoError("a compressed array is cut short");
  std::uint64_t word;
  std::memcpy(&word, packed.data() + offset, kWord);
  return word;
}

}  // namespace

std::string pack_blocks(std::string_view bytes) {
  std::vector<std::uint64_t> header{(bytes.size() + kBlock - 1) / kBlock, kBlock, bytes.size() % kBlock};
  std::string data;
  for (std::size_t begin = 0; begin < bytes.size(); begin += kBlock) {
    const std::string packed = pack_block(bytes.substr(begin, kBlock));
    header.push_back(packed.size());
    data += packed;
  }
  return std::string(reinterpret_cast<const char*>(header.data()), header.size() * kWord) + data;
}

std::string unpack_blocks(std::string_view packed, std::size_t offset) {
  const std::uint64_t blocks = word_at(packed, offset), full = word_at(packed, offset + kWord),
                      partial = word_at(packed, offset + 2 * kWord);
  if (blocks > packed.size() / kWord || full > kBlock || partial >= kBlock) throw IoError("an array header is damaged");
  std::size_t data = offset + (3 + blocks) * kWord;
  std::string bytes;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const std::uint64_t size = word_at(packed, offset + (3 + i) * kWord);
    if (data > packed.size() || size > packed.size() - data) throw IoError("a compressed array is cut short");
    unpack_block(packed.substr(data, size), bytes, i + 1 == blocks && partial ? partial : full);
    data += size;
  }
  return bytes;
}

}  // namespace moraine
