// SPDX-License-Identifier: Apache-2.0
// All that is known of a traced run, and the forms in which it is told.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "ghost_overhead.hpp"
#include "runtime/profile/profile.hpp"
#include "runtime/profile/verdict.hpp"

namespace moraine::app {

struct Findings {
  runtime::Trace trace;
  runtime::Profile profile;
  runtime::Workload work;
  GhostOverhead ghosts;
  runtime::Cures cures;
  std::optional<runtime::Culprit> culprit;
  std::optional<runtime::Advice> advice;
  std::string sentence;

  double cores() const { return trace.settings.all_cores(); }
};

/// Tables for people.
std::string text_of(const Findings& findings, std::size_t top);
nlohmann::ordered_json json_of(const Findings& findings);
/// One page that needs nothing else.
std::string page_of(const Findings& findings);

}  // namespace moraine::app
