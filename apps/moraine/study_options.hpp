// SPDX-License-Identifier: Apache-2.0
// Command-line options that `tradeoff` and `tune` share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "study/laboratory.hpp"
#include "study/row.hpp"
#include "study/subject.hpp"

namespace moraine::app {

class StudyOptions {
 public:
  /// `kind`: of the folder for results, out/NAME-KIND.
  explicit StudyOptions(std::string kind) : kind_(std::move(kind)) {}
  void add_to(CLI::App& command);

  /// The scene with --set and the environment. Errors: InputError.
  study::Subject subject() const;
  /// The subject's grid, narrowed.
  std::vector<AxisBlock> grid(const study::Subject& subject) const;
  study::Laboratory laboratory(const study::Subject& subject) const;
  std::filesystem::path folder(const study::Subject& subject) const;
  int seeds(const study::Subject& subject) const;
  int first_seed() const { return first_seed_; }
  int threads() const { return threads_; }
  int at_once() const;
  study::Seconds seconds() const;

 private:
  std::string kind_, file_, out_, clock_ = "wall";
  std::vector<std::string> sets_, varied_, observables_;
  std::map<std::string, std::vector<std::string>> axes_;  ///< by short name
  int seeds_ = 0, first_seed_ = 1, at_once_ = 0, threads_ = 1;
  bool quiet_ = false;
};

}  // namespace moraine::app
