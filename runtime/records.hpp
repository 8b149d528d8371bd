// SPDX-License-Identifier: Apache-2.0
// Lists of plain records to bytes and back, for ranks of one run. Machines of one kind only.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace moraine::runtime {

/// Appends the number of records and the records.
template <class Record>
void write_records(std::vector<std::byte>& out, const std::vector<Record>& records) {
  static_assert(std::is_trivially_copyable_v<Record>);
  const std::size_t count = records.size(), at = out.size(), size = count * sizeof(Record);
  out.resize(at + sizeof count + size);
  std::memcpy(out.data() + at, &count, sizeof count);
  if (size > 0) std::memcpy(out.data() + at + sizeof count, records.data(), size);
}

/// Takes from the front of `in` what write_records() wrote. Errors: std::runtime_error if `in` is too short.
template <class Record>
std::vector<Record> read_records(std::span<const std::byte>& in) {
  static_assert(std::is_trivially_copyable_v<Record>);
  std::size_t count = 0;
  if (in.size() < sizeof count) throw std::runtime_error("saved records are truncated");
  std::memcpy(&count, in.data(), sizeof count);
  in = in.subspan(sizeof count);
  if (count > in.size() / sizeof(Record)) throw std::runtime_error("saved records are truncated");
  std::vector<Record> records(count);
  if (count > 0) std::memcpy(records.data(), in.data(), count * sizeof(Record));
  in = in.subspan(count * sizeof(Record));
  return records;
}

}  // namespace moraine::runtime
