// SPDX-License-Identifier: Apache-2.0
#include "interrupted.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace moraine::app {
namespace {

// A signal handler may use little more than these.
std::string note_text;
std::string mark_path;
constexpr std::array handled{SIGTERM, SIGINT};

void speak(int signal) {
  const int mark = ::open(mark_path.c_str(), O_CREAT | O_EXCL | O_WRONLY, 0666);
  if (mark >= 0 && ::write(STDERR_FILENO, note_text.data(), note_text.size()) < 0) _exit(1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

LastWord::LastWord(const std::string& note, const std::filesystem::path& mark) {
  note_text = note;
  mark_path = mark.string();
  std::error_code none;
  std::filesystem::remove(mark, none);
  for (const int signal : handled) std::signal(signal, speak);
}

LastWord::~LastWord() {
  for (const int signal : handled) std::signal(signal, SIG_DFL);
}

}  // namespace moraine::app
