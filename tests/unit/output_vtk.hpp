// SPDX-License-Identifier: Apache-2.0
// Has VTK open what a run leaves behind.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace moraine::sample {

using Json = nlohmann::json;

/// What VTK's own reader finds in the folder.
inline Json seen_by_vtk(const std::filesystem::path& folder) {
  const std::string command =
      std::string("/usr/bin/python3 " MORAINE_SOURCE_DIR "/tests/support/vtk_check.py ") + folder.string();
  std::FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  const int status = pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 3) throw std::runtime_error("the package python3-vtk9 is missing");
  if (status != 0) throw std::runtime_error("vtk_check.py failed: " + command);
  return Json::parse(text);
}

}  // namespace moraine::sample
