// SPDX-License-Identifier: Apache-2.0
// Runs what a study needs, each run once: finished ones are files and are found again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/folder_lock.hpp"
#include "study/record.hpp"
#include "study/subject.hpp"

namespace moraine::study {

struct LaboratoryOptions {
  std::filesystem::path program;  ///< moraine
  std::filesystem::path folder;   ///< finished runs are in its `runs`
  int at_once = 1;
  int threads = 1;  ///< of each run
  bool quiet = false;
};

struct Trial {
  const Setting* setting = nullptr;
  int seed = 1;
};

class Laboratory {
 public:
  /// Errors: InputError if the folder cannot be written, or if another study writes there.
  explicit Laboratory(LaboratoryOptions options);

  /// Runs the trials that no file has for this very scene, setting, seed, program, engine libraries and number of runs
  /// at the same time; says on standard error how far it is, and how many files were of others. Records in the order of
  /// the trials. Errors: InputError if the scene or the program changes meanwhile.
  std::vector<Record> run(const Subject& subject, const std::vector<Trial>& trials);

  int runs_made() const { return runs_made_; }
  double cpu_seconds() const { return cpu_seconds_; }
  const LaboratoryOptions& options() const { return options_; }

 private:
  class Batch;
  LaboratoryOptions options_;
  FolderLock lock_;
  std::string program_hash_;
  int runs_made_ = 0;
  double cpu_seconds_ = 0;  ///< in the steps of the runs made
};

}  // namespace moraine::study
