// SPDX-License-Identifier: Apache-2.0
// moraine tune: the cheapest settings that are good enough.
#pragma once

#include "study_options.hpp"

namespace moraine::app {

struct TuneChoices {
  StudyOptions study{"tune"};
  std::string wish;
  int fresh_seeds = 5, most_seeds = 12;
  bool proxy_only = false;

  void add_to(CLI::App& command);
};

/// Exit status if nothing in reach is good enough.
constexpr int not_good_enough = 5;

/// Leaves tune.md and tune.json in the study's folder. Returns 0, or not_good_enough.
int tune(const TuneChoices& choices);

}  // namespace moraine::app
