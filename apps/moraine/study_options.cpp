// SPDX-License-Identifier: Apache-2.0
#include "study_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "identity.hpp"
#include "options.hpp"
#include "physics/errors.hpp"
#include "runtime/cores.hpp"

namespace moraine::app {
namespace {

constexpr std::array varied_by_option{"engine", "dt", "substeps", "iterations", "sub_models", "coupling", "split"};

std::string flag_text(const std::string& name) {
  std::string flag = "--" + name;
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

/// `key=value,value`
Axis parse_varied(const std::string& text) {
  const auto equals = text.find('=');
  Axis axis{text.substr(0, equals), {}, "--vary"};
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InputError(fmt::format("--vary {}: expected key=value,value,...", text));
  std::istringstream in(text.substr(equals + 1));
  for (std::string value; std::getline(in, value, ',');) axis.values.push_back(value);
  return axis;
}

}  // namespace

void StudyOptions::add_to(CLI::App& command) {
  command.add_option("scene", file_, "scene file")->required();
  command.add_option("--set", sets_, "parameter=value or path.to.key=value, for all runs")->take_all()->expected(1);
  for (const std::string name : varied_by_option)
    command.add_option(flag_text(name), axes_[name], "values to try instead of the scene's")->delimiter(',');
  command.add_option("--vary", varied_, "key=value,value: another setting to vary")->take_all()->expected(1);
  command.add_option("--observables", observables_, "what counts, instead of what the scene says")->delimiter(',');
  command.add_option("--out", out_, "folder for results (default out/NAME-" + kind_ + ")");
  command.add_option("--seeds", seeds_, "runs of each setting and of the reference")->check(CLI::PositiveNumber);
  command.add_option("--first-seed", first_seed_, "seeds count up from here")->check(CLI::NonNegativeNumber);
  command.add_option("--jobs", at_once_, "runs at the same time (default: as many as there are cores)")
      ->check(CLI::PositiveNumber);
  command.add_option("--threads", threads_, "of each run")->check(CLI::PositiveNumber);
  command.add_option("--clock", clock_, "speeds by wall time, or by processor time, which other programs disturb less")
      ->check(CLI::IsMember({"wall", "processor"}));
  command.add_flag("--quiet", quiet_, "no progress");
}

study::Subject StudyOptions::subject() const {
  std::vector<Override> overrides = environment_overrides();
  for (const std::string& text : sets_) overrides.push_back(parse_set(text));
  if (!observables_.empty())
    overrides.push_back({"tradeoff.observables", fmt::format("[{}]", fmt::join(observables_, ", ")), "--observables"});
  return {file_, overrides, identity};
}

std::vector<AxisBlock> StudyOptions::grid(const study::Subject& subject) const {
  std::vector<AxisBlock> blocks = subject.grid();
  for (const std::string name : varied_by_option)
    if (const auto& values = axes_.at(name); !values.empty()) study::narrow(blocks, {name, values, flag_text(name)});
  for (const std::string& text : varied_) study::narrow(blocks, parse_varied(text));
  return blocks;
}

std::filesystem::path StudyOptions::folder(const study::Subject& subject) const {
  if (!out_.empty()) return out_;
  return std::filesystem::path("out") / (subject.scene().name + "-" + kind_);
}

study::Laboratory StudyOptions::laboratory(const study::Subject& subject) const {
  return study::Laboratory(
      {std::filesystem::read_symlink("/proc/self/exe"), folder(subject), at_once(), threads_, quiet_});
}

int StudyOptions::seeds(const study::Subject& subject) const {
  return seeds_ > 0 ? seeds_ : subject.scene().study.seeds;
}

int StudyOptions::at_once() const { return at_once_ > 0 ? at_once_ : std::max(1, runtime::usable_cores() / threads_); }

study::Seconds StudyOptions::seconds() const {
  return clock_ == "wall" ? study::Seconds::wall : study::Seconds::processor;
}

}  // namespace moraine::app
