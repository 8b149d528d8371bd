// SPDX-License-Identifier: Apache-2.0
// Command-line options that stand for keys of the scene file, and their names in the environment.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "physics/scene/reader.hpp"

namespace moraine::app {

/// What MORAINE_ variables say, one per option of the table.
std::vector<Override> environment_overrides();
/// `name=value`, as --set takes it. Errors: InputError.
Override parse_set(const std::string& text);

/// A scene file and what overrides it: environment first, then the command line, so that the command line wins.
class SceneOptions {
 public:
  /// Adds the scene argument, --set, and one option per row of the table to a subcommand.
  void add_to(CLI::App& command);
  const std::string& file() const { return file_; }
  /// Reads the scene. Errors: InputError.
  Scene read() const;

 private:
  std::string file_;
  std::vector<std::string> sets_;
  std::vector<std::string> values_;  ///< of the table's rows; empty: not given
};

}  // namespace moraine::app
