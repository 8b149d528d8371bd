// SPDX-License-Identifier: Apache-2.0
// What writes the frames of a run, and the table of formats.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "output/frame.hpp"

namespace moraine {

/// Writes frames, in order of time, below one folder. Frames that were there before a restart stay, those from its
/// first frame on are replaced. Errors: IoError naming the path. Used by one thread.
class Writer {
 public:
  virtual ~Writer() = default;
  /// Leaves files that open, even if no further frame follows.
  virtual void write(const Frame& frame) = 0;
  /// After the last frame: closes what is open.
  virtual void finish() {}
};

/// A row of the table of formats. The scene must outlive the writer; the folder must exist.
struct WriterRow {
  const char* name;
  const char* help;
  std::unique_ptr<Writer> (*make)(const Scene& scene, const std::filesystem::path& folder);
};

std::span<const WriterRow> writers();

/// Errors: InputError listing the table if there is no such name.
const WriterRow& find_writer(std::string_view name);

}  // namespace moraine
