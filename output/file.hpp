// SPDX-License-Identifier: Apache-2.0
// Files that are written in full or reported: every failed open, write, close and rename names its path.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace moraine {

/// A file open for writing. Errors: IoError naming the path. A file left unclosed is closed silently: call close().
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path, bool append = false);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  void flush();
  void close();

 private:
  [[noreturn]] void fail(const char* what) const;
  std::filesystem::path path_;
  std::FILE* file_;
};

/// Replaces `path` in one move, so that a reader sees the old text or the new, never a part. Errors: IoError.
void replace_file(const std::filesystem::path& path, std::string_view text);

/// The whole file. Errors: IoError.
std::string read_file(const std::filesystem::path& path);

/// Makes a folder and those above it. Errors: IoError.
void make_folder(const std::filesystem::path& path);

}  // namespace moraine
