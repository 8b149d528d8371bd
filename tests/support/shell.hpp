// SPDX-License-Identifier: Apache-2.0
// Runs the command under test from a shell.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace moraine::test {

struct Ended {
  int status = -1;
  std::string text;  ///< of both streams
};

/// The shell's words before a program that is to run on so many ranks; 0: without mpirun.
inline std::string mpirun(int ranks, const std::string& options = "") {
  if (ranks == 0) return "";
  return "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe " + options + "-np " +
         std::to_string(ranks) + " ";
}

/// Runs a shell line in which `moraine` is the command under test, in an environment without MORAINE_ variables.
inline Ended shell(const std::string& line) {
  const std::string whole =
      "for v in $(env | sed -n 's/^\\(MORAINE_[A-Z_]*\\)=.*/\\1/p'); do unset $v; done; moraine() { " +
      std::string(MORAINE_COMMAND) + " \"$@\"; }; { " + line + "\n} 2>&1";
  FILE* pipe = ::popen(whole.c_str(), "r");
  Ended ended;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) ended.text.append(buffer.data(), n);
  const int raw = ::pclose(pipe);
  ended.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  return ended;
}

}  // namespace moraine::test
