// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "physics/errors.hpp"

namespace moraine::app {
namespace {

struct Row {
  const char* flag;
  const char* key;  ///< in the scene file
  const char* help;
};

constexpr std::array table{
    Row{"--out", "output.folder", "folder for results (default out/NAME)"},
    Row{"--steps", "time.steps", "number of steps"},
    Row{"--dt", "time.dt", "one step [s]"},
    Row{"--substeps", "time.substeps", "engine steps per step; sub-models are coupled after each"},
    Row{"--threads", "run.threads", "worker threads of each rank (default: its share of the cores it may use)"},
    Row{"--engine", "run.engine", "engine, see 'moraine list', or auto: impulse for spheres, else bullet"},
    Row{"--sub-models", "run.sub_models", "number of sub-models, or auto"},
    Row{"--split", "run.split", "how the scene is cut, see 'moraine list'"},
    Row{"--coupling", "run.coupling", "how sub-models are coupled, see 'moraine list'"},
    Row{"--skip-threshold", "run.skip_threshold", "sub-models slower than this are skipped [sqrt(g d)]; 0: none"},
    Row{"--iterations", "run.iterations", "solver iterations per substep"},
    Row{"--scheduler", "run.scheduler", "order of tasks, see 'moraine list'"},
    Row{"--balancer", "run.balancer", "which rank owns which sub-model, see 'moraine list'"},
    Row{"--balance-every", "run.balance_every", "steps from one balance to the next, at least"},
    Row{"--load-prediction", "run.load_prediction", "how loads are predicted for a balance, see 'moraine list'"},
    Row{"--checkpoint-every", "run.checkpoint_every", "steps from one checkpoint to the next, at least; 0: none"},
    Row{"--restart", "run.restart", "go on from a checkpoint: its folder, or 'latest' of --out"},
    Row{"--trace", "run.trace", "write what ran where and when: .json for Perfetto, else compact"},
    Row{"--trace-window", "run.trace_window", "FROM:TO[:EVERY]: trace these steps only, every so many epochs"},
    Row{"--output-every", "output.every", "steps between frames; 0: first and last only"},
};

/// "--sub-models" -> "MORAINE_SUB_MODELS"
std::string environment_name(std::string_view flag) {
  std::string name = "MORAINE_";
  for (const char c : flag.substr(2)) name += c == '-' ? '_' : static_cast<char>(std::toupper(c));
  return name;
}

/// An empty value would count as none: `--restart "$folder"` would begin anew if the variable is not set.
std::string refuse_empty(const std::string& value) { return value.empty() ? "is empty, expected a value" : ""; }

}  // namespace

std::vector<Override> environment_overrides() {
  std::vector<Override> overrides;
  for (const Row& row : table)
    if (const std::string name = environment_name(row.flag); const char* value = std::getenv(name.c_str()))
      overrides.push_back({row.key, value, name});
  return overrides;
}

Override parse_set(const std::string& text) {
  const auto at = text.find('=');
  if (at == std::string::npos || at == 0)
    throw InputError(fmt::format("--set {}: expected name=value or path.to.key=value", text));
  return {text.substr(0, at), text.substr(at + 1), "--set"};
}

void SceneOptions::add_to(CLI::App& command) {
  values_.resize(table.size());
  command.add_option("scene", file_, "scene file")->required();
  command.add_option("--set", sets_, "parameter=value or path.to.key=value; may be repeated")->take_all()->expected(1);
  for (std::size_t i = 0; i < table.size(); ++i)
    command.add_option(table[i].flag, values_[i], table[i].help)->check(refuse_empty);
}

Scene SceneOptions::read() const {
  std::vector<Override> overrides = environment_overrides();
  for (const std::string& s : sets_) overrides.push_back(parse_set(s));
  for (std::size_t i = 0; i < table.size(); ++i)
    if (!values_[i].empty()) overrides.push_back({table[i].key, values_[i], table[i].flag});
  return read_scene(file_, overrides);
}

}  // namespace moraine::app
