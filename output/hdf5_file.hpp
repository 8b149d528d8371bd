// SPDX-License-Identifier: Apache-2.0
// The little of HDF5 that growing tables need. The library is not safe for threads: all files of a process are to be
// used by one thread at a time.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "output/columns.hpp"

namespace moraine {

/// Owns an HDF5 identifier and closes it with the function it was given.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& o) noexcept : id_(std::exchange(o.id_, -1)), close_(o.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  operator hid_t() const { return id_; }
  /// The result of closing, which is where delayed writes fail.
  herr_t close() { return close_(std::exchange(id_, -1)); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Names are paths inside the file. Errors of every call: IoError naming the file and what failed.
class Hdf5File {
 public:
  /// A new file, or one that is there, to go on with.
  explicit Hdf5File(std::filesystem::path path, bool go_on = false);

  void group(const std::string& name);
  void attribute(const std::string& object, const char* name, const std::vector<std::int64_t>& values);
  /// One number, written over if it is there.
  void attribute(const std::string& object, const char* name, std::int64_t value);
  void attribute(const std::string& object, const char* name, const std::string& text);
  /// Adds rows to the table of that name, made at first use: chunked, shuffled and deflated.
  void append(const std::string& name, const Column& rows);
  void append(const std::string& name, std::int64_t row);
  /// The number that attribute() wrote.
  std::int64_t number(const std::string& object, const char* name);
  /// A table of one column, as doubles; nothing if there is no such table.
  std::vector<double> numbers(const std::string& name);
  /// Drops all rows of a table but the first `rows`, which must be there.
  void keep(const std::string& name, std::int64_t rows);
  void flush();
  void close();

 private:
  bool has(const std::string& name) const;
  hid_t check(hid_t result, const std::string& what) const;
  Hdf5Handle create_table(const std::string& name, const Column& rows);
  Hdf5Handle open(const std::string& object);
  Hdf5Handle open_table(const std::string& name);

  std::filesystem::path path_;
  Hdf5Handle file_;
};

}  // namespace moraine
