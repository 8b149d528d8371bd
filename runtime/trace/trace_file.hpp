// SPDX-License-Identifier: Apache-2.0
// Traces in files: the compact binary form. A head, then blocks, each with its length and checksum: settings first,
// then lists as they come, last an empty block that says that the run ended. If it went on, more follow.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <vector>

#include "runtime/trace/trace.hpp"

namespace moraine::runtime {

/// A file is not a trace, is damaged, or of another version. Says which file and what was expected.
class TraceError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Columns of bytes, compressed with zstd level 1. Cost: about 1 ns per byte of the records.
std::vector<std::byte> pack(const TraceLists& lists);
/// Appends what was packed. Errors: TraceError if it is damaged.
void unpack(std::span<const std::byte> packed, TraceLists& lists);

class TraceWriter {
 public:
  /// Errors: std::runtime_error naming the file, here and below.
  TraceWriter(const std::filesystem::path& file, const TraceSettings& settings);
  /// Lists that pack() has packed. They are in the file when this returns.
  void append(std::span<const std::byte> packed);
  /// The run has ended: the trace is complete, unless more is appended.
  void finish();

 private:
  enum class Kind : std::uint32_t;
  void write(Kind kind, std::span<const std::byte> content);

  friend class TraceReader;
  std::filesystem::path path_;
  std::ofstream file_;
};

/// Records in the order (rank, start) and so on. A trace that was cut short is read as far as it goes.
/// Errors: TraceError.
Trace read_trace_file(const std::filesystem::path& file);

/// Puts lists in an order that does not depend on how they were gathered: tasks by (rank, worker, start), phases by
/// (rank, start), others by epoch and number.
void sort(TraceLists& lists);

}  // namespace moraine::runtime
