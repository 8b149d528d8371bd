// SPDX-License-Identifier: Apache-2.0
#include "study/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <string_view>

#include "physics/errors.hpp"

namespace moraine::study {
namespace {

constexpr int cannot_execute = 127;

/// Options of this command, and what tells a rank of mpirun who it is, are not for those that it starts.
bool kept(std::string_view variable) {
  if (variable.starts_with("MORAINE_ENGINES=")) return true;
  for (const std::string_view prefix : {"MORAINE_", "OMPI_COMM_WORLD_", "PMIX_", "PMI_"})
    if (variable.starts_with(prefix)) return false;
  return true;
}

std::vector<char*> environment() {
  std::vector<char*> kept_ones;
  for (char** v = environ; *v != nullptr; ++v)
    if (kept(*v)) kept_ones.push_back(*v);
  kept_ones.push_back(nullptr);
  return kept_ones;
}

/// In the child: becomes the program. Uses nothing but system calls.
[[noreturn]] void become(char** arguments, char** variables, const char* errors) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int nothing = ::open("/dev/null", O_RDWR);
  const int file = ::open(errors, O_CREAT | O_TRUNC | O_WRONLY, 0666);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  ::execve(arguments[0], arguments, variables);
  ::_exit(cannot_execute);
}

pid_t start(const Process& process) {
  std::vector<char*> arguments;
  for (const std::string& a : process.arguments) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> variables = environment();
  const pid_t child = ::fork();
  if (child < 0) throw IoError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (child == 0) become(arguments.data(), variables.data(), process.errors.c_str());
  return child;
}

int status_of(int raw) { return WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw); }

}  // namespace

void run_all(const std::vector<Process>& processes, int at_once, const std::function<void(std::size_t, int)>& done) {
  std::map<pid_t, std::size_t> running;
  for (std::size_t next = 0; next < processes.size() || !running.empty();) {
    while (next < processes.size() && running.size() < static_cast<std::size_t>(at_once)) {
      running.emplace(start(processes[next]), next);
      ++next;
    }
    int raw = 0;
    const pid_t ended = ::waitpid(-1, &raw, 0);
    if (ended < 0 && errno == EINTR) continue;
    if (ended < 0) throw IoError(fmt::format("cannot wait for a process: {}", std::strerror(errno)));
    const auto found = running.find(ended);
    if (found == running.end()) continue;
    const std::size_t index = found->second;
    running.erase(found);
    if (status_of(raw) == cannot_execute)
      throw IoError(fmt::format("{}: cannot be executed", processes[index].arguments.front()));
    done(index, status_of(raw));
  }
}

}  // namespace moraine::study
