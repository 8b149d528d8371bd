// SPDX-License-Identifier: Apache-2.0
// moraine profile: where the time of a traced run went, and what would help.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

namespace moraine::app {

struct ProfileChoices {
  std::filesystem::path trace;
  std::filesystem::path html;
  bool json = false;
  int top = 5;

  void add_to(CLI::App& command);
};

int profile(const ProfileChoices& choices);

}  // namespace moraine::app
