// SPDX-License-Identifier: Apache-2.0
#include "study/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "physics/errors.hpp"

namespace moraine::study {

FolderLock::FolderLock(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  file_ = error ? -1 : ::open((folder / ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (file_ < 0)
    throw InputError(fmt::format("{}: cannot write there, expected a folder for results (--out)", folder.string()));
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;  // some file systems have no locks
  ::close(file_);
  throw InputError(
      fmt::format("{}: another study writes there, expected a folder of its own (--out)", folder.string()));
}

FolderLock::FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace moraine::study
