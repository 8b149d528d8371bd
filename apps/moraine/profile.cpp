// SPDX-License-Identifier: Apache-2.0
#include "profile.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iostream>

#include "findings.hpp"
#include "physics/errors.hpp"
#include "runtime/trace/chrome.hpp"

namespace moraine::app {
namespace {

std::vector<double> each(const runtime::Profile& profile, double runtime::SubModelProfile::*what) {
  std::vector<double> out;
  for (const runtime::SubModelProfile& s : profile.sub_models) out.push_back(s.*what);
  return out;
}

/// The first epochs of a long trace are enough to tell cures apart.
std::int64_t epochs_to_replay(const runtime::Trace& trace) {
  constexpr double enough = 400'000;  // tasks
  const auto tasks = static_cast<double>(trace.lists.tasks.size()),
             epochs = static_cast<double>(trace.lists.epochs.size());
  return tasks <= enough ? -1 : std::max<std::int64_t>(2, static_cast<std::int64_t>(epochs * enough / tasks));
}

runtime::Cures cures_of(const Findings& f) {
  runtime::CureSearch search{.cores = f.cores(), .halo = f.ghosts.halo()};
  int tried = 0;
  search.progress = [&](const runtime::Cure& cure) {
    std::cerr << fmt::format("replay {}: {}\n", ++tried, runtime::words(cure, f.work));
  };
  return runtime::find_cures(f.work, search);
}

GhostOverhead ghosts_of(const runtime::TraceSettings& settings, const runtime::Profile& profile) {
  std::vector<Counters> counters;
  for (const runtime::SubModelProfile& s : profile.sub_models) counters.push_back(s.counters);
  return ghost_overhead(settings, counters, each(profile, &runtime::SubModelProfile::seconds));
}

Findings find(const std::filesystem::path& file) {
  Findings f;
  f.trace = runtime::read_trace(file);
  f.profile = runtime::profile_of(f.trace);
  f.work = runtime::workload_of(f.trace, epochs_to_replay(f.trace));
  f.ghosts = ghosts_of(f.trace.settings, f.profile);
  f.cures = cures_of(f);
  f.culprit = runtime::culprit_of(each(f.profile, &runtime::SubModelProfile::seconds),
                                  each(f.profile, &runtime::SubModelProfile::awaited));
  f.advice = runtime::advice_of(f.cures, f.work);
  f.sentence = runtime::sentence(f.profile.all, f.culprit, f.advice);
  return f;
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out)
    throw InputError(fmt::format("{}: cannot write there, expected a file for the page (--html)", file.string()));
}

}  // namespace

void ProfileChoices::add_to(CLI::App& command) {
  command.add_option("trace", trace, "a trace in either form")->required();
  command.add_option("--html", html, "write one page: timeline, loads, owners, critical path");
  command.add_option("--top", top, "rows of tables that could be long")->check(CLI::PositiveNumber);
  command.add_flag("--json", json, "the same for programs");
}

int profile(const ProfileChoices& choices) {
  const Findings findings = find(choices.trace);
  if (!choices.html.empty()) write(choices.html, page_of(findings));
  if (choices.json)
    std::cout << json_of(findings).dump(2) << '\n';
  else
    std::cout << text_of(findings, static_cast<std::size_t>(choices.top));
  return 0;
}

}  // namespace moraine::app
