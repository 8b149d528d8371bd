// SPDX-License-Identifier: Apache-2.0
#include "tune.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <iostream>

#include "output/file.hpp"
#include "physics/errors.hpp"
#include "study/tuning_report.hpp"

namespace moraine::app {
namespace {

using Clock = std::chrono::steady_clock;

/// "2%" and "0.02" are the same.
double parse_wish(std::string text) {
  const std::string given = text;
  const bool percent = !text.empty() && text.back() == '%';
  if (percent) text.pop_back();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  value /= percent ? 100 : 1;
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0) || !(value < 1))
    throw InputError(fmt::format("--error {}: expected a share between 0 and 1, or per cent such as 2%", given));
  return value;
}

}  // namespace

void TuneChoices::add_to(CLI::App& command) {
  study.add_to(command);
  command.add_option("--error", wish, "the largest error: 2% or 0.02")->required();
  command.add_option("--fresh-seeds", fresh_seeds, "that a setting is judged by, at least")->check(CLI::Range(2, 1000));
  command.add_option("--most-seeds", most_seeds, "of a setting, or of the reference")->check(CLI::Range(2, 100'000));
  command.add_flag("--proxy-only", proxy_only,
                   "judge on the small scene: the scene itself is too large for the reference");
}

int tune(const TuneChoices& choices) {
  const auto begin = Clock::now();
  study::TuningReport report;
  report.options.wish = parse_wish(choices.wish);
  const study::Subject subject = choices.study.subject();
  study::Laboratory laboratory = choices.study.laboratory(subject);
  report.file = subject.file();
  report.subject = &subject;
  report.options.seeds = choices.study.seeds(subject);
  report.options.first_seed = choices.study.first_seed();
  report.options.fresh_seeds = choices.fresh_seeds;
  report.options.most_seeds = std::max(choices.most_seeds, choices.fresh_seeds);
  report.options.proxy_only = choices.proxy_only;
  report.options.seconds = choices.study.seconds();
  report.at_once = choices.study.at_once();
  report.threads = choices.study.threads();
  report.tuned = study::tune(subject, choices.study.grid(subject), laboratory, report.options);
  report.runs = laboratory.runs_made();
  report.cpu_s = laboratory.cpu_seconds();
  report.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::filesystem::path folder = choices.study.folder(subject);
  replace_file(folder / "tune.json", tuning_json(report));
  replace_file(folder / "tune.md", tuning_text(report));
  std::cout << tuning_text(report);
  return report.tuned.found ? 0 : not_good_enough;
}

}  // namespace moraine::app
