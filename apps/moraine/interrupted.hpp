// SPDX-License-Identifier: Apache-2.0
// A last word when the run is told to stop, as mpirun does when one of its processes has died.
#pragma once

#include <filesystem>
#include <string>

namespace moraine::app {

/// While this lives, SIGTERM and SIGINT print `note` before they end the process. Of several ranks that are stopped
/// together the first to make the file `mark` speaks.
class LastWord {
 public:
  LastWord(const std::string& note, const std::filesystem::path& mark);
  ~LastWord();
  LastWord(const LastWord&) = delete;
  LastWord& operator=(const LastWord&) = delete;
};

}  // namespace moraine::app
