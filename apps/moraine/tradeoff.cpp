// SPDX-License-Identifier: Apache-2.0
#include "tradeoff.hpp"

#include <fmt/format.h>

#include <iostream>

#include "output/file.hpp"
#include "runtime/cores.hpp"
#include "study/report.hpp"
#include "study/tuning.hpp"

namespace moraine::app {
namespace {

using namespace study;

/// Seed by seed, so that an interrupted study has something of every setting.
std::vector<Trial> trials_of(const std::vector<Setting>& settings, int first_seed, int seeds) {
  std::vector<Trial> trials;
  for (int k = 0; k < seeds; ++k)
    for (const Setting& s : settings) trials.push_back({&s, first_seed + k});
  return trials;
}

/// The records of one setting out of those of trials_of().
std::vector<Record> of_setting(const std::vector<Record>& records, std::size_t setting, std::size_t settings) {
  std::vector<Record> own;
  for (std::size_t i = setting; i < records.size(); i += settings) own.push_back(records[i]);
  return own;
}

void write(const study::Report& report, const std::filesystem::path& folder) {
  replace_file(folder / "settings.csv", csv_text(report));
  replace_file(folder / "settings.json", json_text(report));
  replace_file(folder / "front.md", front_text(report));
  replace_file(folder / "plot.svg", plot_text(report));
}

/// A study in progress.
class Tradeoff {
 public:
  Tradeoff(const TradeoffChoices& choices, const std::string& command)
      : choices_(choices),
        subject_(choices.study.subject()),
        laboratory_(choices.study.laboratory(subject_)),
        seeds_(choices.study.seeds(subject_)) {
    for (const std::string& text : choices.peers) report_.peers.push_back(read_peer(text));
    report_.command = command;
    report_.scene = subject_.scene().name;
    report_.file = subject_.file();
    report_.duration = subject_.duration();
    report_.elements = subject_.scene().elements.size();
    report_.seeds_text = subject_.seeds_text();
    report_.seconds = choices.study.seconds();
    report_.at_once = choices.study.at_once();
    report_.threads = choices.study.threads();
    report_.cores = runtime::usable_cores();
  }

  study::Report go() {
    const std::vector<Setting> settings = subject_.resolve(combinations(choices_.study.grid(subject_)));
    const std::vector<Record> reference = run_reference(subject_, laboratory_, first_seed(), seeds_);
    const Yardstick yardstick(subject_.scene(), reference);
    report_.marks = yardstick.marks();
    report_.noise = yardstick.noise();
    if (!reference.empty())
      report_.reference = make_row(subject_.resolve(subject_.reference()), reference, yardstick, report_.seconds);
    for (Peer& peer : report_.peers) compare(peer, yardstick);
    run_grid(settings, yardstick);
    return report_;
  }

 private:
  void run_grid(const std::vector<Setting>& settings, const Yardstick& yardstick) {
    const std::vector<Record> records = laboratory_.run(subject_, trials_of(settings, first_seed(), seeds_));
    for (std::size_t i = 0; i < settings.size(); ++i)
      report_.rows.push_back(
          make_row(settings[i], of_setting(records, i, settings.size()), yardstick, report_.seconds));
    report_.front = front_of(report_.rows);
  }

  int first_seed() const { return choices_.study.first_seed(); }

  const TradeoffChoices& choices_;
  Subject subject_;
  Laboratory laboratory_;
  int seeds_;
  study::Report report_;
};

}  // namespace

void TradeoffChoices::add_to(CLI::App& command) {
  study.add_to(command);
  command.add_option("--peer", peers, "NAME=SPEED[,observable=value...]: another program's figures, for comparison")
      ->take_all()
      ->expected(1);
}

int tradeoff(const TradeoffChoices& choices, const std::string& command) {
  const study::Report report = Tradeoff(choices, command).go();
  const std::filesystem::path folder = choices.study.folder(choices.study.subject());
  write(report, folder);
  std::cout << front_text(report) << "\nresults in " << folder.string()
            << ": plot.svg, settings.csv, settings.json, front.md\n";
  return 0;
}

}  // namespace moraine::app
