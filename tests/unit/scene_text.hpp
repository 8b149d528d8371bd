// SPDX-License-Identifier: Apache-2.0
// Scenes from texts, for tests.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "physics/errors.hpp"
#include "physics/scene/reader.hpp"

namespace moraine {

/// A folder of its own that goes away with the test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "moraine_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline Scene scene_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const Folder folder;
  return read_scene(folder.write("scene.yaml", text), overrides);
}

/// What the reader says about a text, from the file's name on; empty if it reads it.
inline std::string error_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  try {
    scene_of(text, overrides);
  } catch (const InputError& e) {
    const std::string what = e.what();
    const auto name = what.find("scene.yaml");
    return name == std::string::npos || name > what.find(':') ? what : what.substr(name);
  }
  return "";
}

}  // namespace moraine
