// SPDX-License-Identifier: Apache-2.0
// moraine tradeoff: speed against error for a grid of settings.
#pragma once

#include "study_options.hpp"

namespace moraine::app {

struct TradeoffChoices {
  StudyOptions study{"tradeoff"};
  std::vector<std::string> peers;

  void add_to(CLI::App& command);
};

/// Leaves settings.csv, settings.json, front.md and plot.svg in the study's folder.
int tradeoff(const TradeoffChoices& choices, const std::string& command);

}  // namespace moraine::app
