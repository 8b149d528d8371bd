// SPDX-License-Identifier: Apache-2.0
// What a search found, in words that claim no more than the seeds allow.
#pragma once

#include <string>

#include "study/tuning.hpp"

namespace moraine::study {

/// The subject of a search, what it took, and what came of it.
struct TuningReport {
  std::string file;
  const Subject* subject = nullptr;
  TuningOptions options;
  Tuned tuned;
  int runs = 0;  ///< made; others were there already
  double wall_s = 0, cpu_s = 0;
  int at_once = 1, threads = 1;
};

/// Markdown: the settings to paste and their evidence, or why nothing is good enough.
std::string tuning_text(const TuningReport& report);
std::string tuning_json(const TuningReport& report);

}  // namespace moraine::study
