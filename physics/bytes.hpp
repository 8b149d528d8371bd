// SPDX-License-Identifier: Apache-2.0
// Plain values to bytes and back, for messages and saved worlds. Little-endian machines of one kind only.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "physics/errors.hpp"

namespace moraine {

class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& out) : out_(out) {}

  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof(T));
  }
  template <class T>
  void put_all(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size_bytes());
  }

 private:
  void append(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t at = out_.size();
    out_.resize(at + size);
    std::memcpy(out_.data() + at, data, size);
  }
  std::vector<std::byte>& out_;
};

/// Errors: IoError when the bytes end early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> in) : in_(in) {}

  template <class T>
  T get() {
    T value;
    read(&value, sizeof(T));
    return value;
  }
  template <class T>
  void get_all(std::vector<T>& out) {
    const auto count = get<std::uint64_t>();
    if (count > in_.size() / sizeof(T)) throw IoError("message or saved state is truncated");
    out.resize(count);
    read(out.data(), count * sizeof(T));
  }
  bool at_end() const { return in_.empty(); }

 private:
  void read(void* to, std::size_t size) {
    if (size > in_.size()) throw IoError("message or saved state is truncated");
    if (size > 0) std::memcpy(to, in_.data(), size);
    in_ = in_.subspan(size);
  }
  std::span<const std::byte> in_;
};

}  // namespace moraine
