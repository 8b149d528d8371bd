// SPDX-License-Identifier: Apache-2.0
// Child processes, several at once.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace moraine::study {

struct Process {
  std::vector<std::string> arguments;  ///< the program first
  std::filesystem::path errors;        ///< file for its standard error; standard output is dropped
};

/// Runs all, at most `at_once` at a time, in order, without MORAINE_ variables in their environment and without what
/// would make them ranks of a parallel job. Calls `done` with index and exit status (128 + signal if one ended it) as
/// each ends. They end with this process. Errors: IoError if one cannot be started.
void run_all(const std::vector<Process>& processes, int at_once, const std::function<void(std::size_t, int)>& done);

}  // namespace moraine::study
