// SPDX-License-Identifier: Apache-2.0
#include "runtime/migrate/durable_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace moraine::runtime {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path) { throw std::system_error(errno, std::generic_category(), path.string()); }

/// An open file.
class File {
 public:
  File(const fs::path& path, int flags) : path_(path), handle_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (handle_ < 0) fail(path_);
  }
  ~File() { ::close(handle_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void write(const Bytes& bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t count = ::write(handle_, bytes.data() + at, bytes.size() - at);
      if (count < 0 && errno != EINTR) fail(path_);
      at += static_cast<std::size_t>(count > 0 ? count : 0);
    }
  }
  Bytes read() {
    Bytes bytes(fs::file_size(path_));
    std::size_t at = 0;
    while (at < bytes.size()) {
      const ssize_t count = ::read(handle_, bytes.data() + at, bytes.size() - at);
      if (count < 0 && errno != EINTR) fail(path_);
      if (count == 0) break;
      at += static_cast<std::size_t>(count > 0 ? count : 0);
    }
    bytes.resize(at);
    return bytes;
  }
  void sync() {
    if (::fsync(handle_) != 0) fail(path_);
  }

 private:
  fs::path path_;
  int handle_;
};

void sync_folder(const fs::path& folder) { File(folder, O_RDONLY | O_DIRECTORY).sync(); }

}  // namespace

Bytes read_file(const fs::path& path) { return File(path, O_RDONLY).read(); }

void write_durably(const fs::path& path, const Bytes& bytes) {
  const fs::path temporary = path.string() + ".partial";
  {
    File file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(bytes);
    file.sync();
  }
  rename_durably(temporary, path);
}

void rename_durably(const fs::path& from, const fs::path& to) {
  if (fs::is_directory(to)) fs::remove_all(to);
  fs::rename(from, to);
  sync_folder(to.parent_path());
}

}  // namespace moraine::runtime
