// SPDX-License-Identifier: Apache-2.0
// One study per folder at a time.
#pragma once

#include <filesystem>

namespace moraine::study {

/// Holds a folder until it goes away, or the process does; where the file system has no locks, nothing is held.
class FolderLock {
 public:
  /// Makes the folder. Errors: InputError if it cannot be written, or if another study holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  int file_;
};

}  // namespace moraine::study
