// SPDX-License-Identifier: Apache-2.0
#include "output/file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "physics/errors.hpp"

namespace moraine {

OutputFile::OutputFile(std::filesystem::path path, bool append)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), append ? "ab" : "wb")) {
  if (!file_) fail("cannot open for writing");
}

OutputFile::~OutputFile() {
  if (file_) std::fclose(file_);
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot write");
}

void OutputFile::flush() {
  if (std::fflush(file_) != 0) fail("cannot write");
}

void OutputFile::close() {
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("cannot write");
}

void OutputFile::fail(const char* what) const {
  throw IoError(fmt::format("{}: {}: {}", path_.string(), what, std::strerror(errno)));
}

void replace_file(const std::filesystem::path& path, std::string_view text) {
  std::filesystem::path temporary = path;
  temporary += ".part";
  OutputFile file(temporary);
  file.write(text);
  file.close();
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) throw IoError(fmt::format("{}: cannot replace: {}", path.string(), error.message()));
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad()) {
    throw IoError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  }
  return text;
}

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw IoError(fmt::format("{}: cannot make the folder: {}", path.string(), error.message()));
}

}  // namespace moraine
