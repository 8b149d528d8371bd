// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <chrono>
#include <fstream>
#include <iostream>

#include "output/file.hpp"
#include "output/label.hpp"
#include "physics/errors.hpp"
#include "study/process.hpp"

namespace moraine::study {
namespace {

using Clock = std::chrono::steady_clock;

std::string hash_of(std::string_view text) { return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size())); }

void check_writable(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::ofstream(folder / ".writable"))
    throw InputError(fmt::format("{}: cannot write there, expected a folder for results (--out)", folder.string()));
  std::filesystem::remove(folder / ".writable", error);
}

Override split_at_equals(const std::string& text) {
  const auto equals = text.find('=');
  return {text.substr(0, equals), text.substr(equals + 1), "the study"};
}

/// Without the name of the program, which its messages begin with.
std::string trimmed(std::string text) {
  if (text.starts_with("moraine: ")) text.erase(0, 9);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace

/// One call of run().
class Laboratory::Batch {
 public:
  Batch(Laboratory& lab, const Subject& subject, const std::vector<Trial>& trials) : lab_(lab), trials_(trials) {
    for (const Trial& t : trials) prepare(subject, t);
  }

  std::vector<Record> go() {
    announce();
    std::vector<Process> processes;
    for (const std::size_t i : missing_) processes.push_back(process(i));
    run_all(processes, lab_.options_.at_once, [&](std::size_t k, int status) { finish(missing_[k], status); });
    return std::move(records_);
  }

 private:
  void prepare(const Subject& subject, const Trial& t) {
    std::vector<Override> overrides = subject.overrides(*t.setting, t.seed);
    overrides.push_back({"run.threads", std::to_string(lab_.options_.threads), "the study"});
    Record r;
    r.command = command_line(subject.file(), overrides);
    r.identity = t.setting->identity + "-" + lab_.program_hash_;
    r.at_once = lab_.options_.at_once;
    const std::filesystem::path path = lab_.options_.folder / "runs" / (t.setting->engine + "-" + hash_of(r.command));
    const std::optional<Record> found = read_record(path.string() + ".json");
    if (found && found->identity != r.identity) ++outdated_;
    const bool usable = found && found->identity == r.identity && found->final();
    if (!usable) missing_.push_back(records_.size());
    records_.push_back(usable ? *found : r);
    paths_.push_back(path);
    arguments_.push_back(arguments(subject.file(), overrides, path));
  }

  std::vector<std::string> arguments(const std::string& file, std::vector<Override> overrides,
                                     const std::filesystem::path& folder) const {
    for (const char* nothing : {"every=0", "formats=[]", "pictures=false"})
      overrides.push_back(split_at_equals(std::string("output.") + nothing));
    std::vector<std::string> all{lab_.options_.program.string(), "run", file, "--quiet", "--out", folder.string()};
    for (const Override& o : overrides) {
      all.emplace_back("--set");
      all.push_back(o.key + "=" + o.value);
    }
    return all;
  }

  Process process(std::size_t i) const { return {arguments_[i], paths_[i].string() + ".errors"}; }

  void say(const std::string& text) const {
    if (!lab_.options_.quiet) std::cerr << text << '\n';
  }

  void announce() const {
    if (outdated_ > 0)
      say(fmt::format("{} finished runs are of another version of the scene or the program; they are repeated",
                      outdated_));
    const std::size_t found = trials_.size() - missing_.size();
    if (found > 0) say(fmt::format("{} of {} runs are there already", found, trials_.size()));
  }

  void finish(std::size_t i, int status) {
    Record& r = records_[i];
    const std::filesystem::path errors = paths_[i].string() + ".errors";
    r.status = status;
    if (r.good()) r.summary = nlohmann::json::parse(read_file(paths_[i] / "summary.json"));
    if (!r.good())
      r.message = status > 128 ? fmt::format("ended by signal {}", status - 128) : trimmed(read_file(errors));
    write_record(r, paths_[i].string() + ".json");
    std::filesystem::remove(errors);
    std::filesystem::remove_all(paths_[i]);
    ++lab_.runs_made_;
    if (r.good()) lab_.cpu_seconds_ += r.summary.value("loop_cpu_s", 0.0);
    say(progress(i, ++ended_));
  }

  std::string progress(std::size_t i, std::size_t ended) const {
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
    const double left = elapsed / static_cast<double>(ended) * static_cast<double>(missing_.size() - ended);
    const Record& r = records_[i];
    const std::string outcome =
        r.good() ? fmt::format("{:.3g} s", r.summary.value("loop_wall_s", 0.0)) : fmt::format("status {}", r.status);
    return fmt::format("{:>4} of {}  {}, seed {}: {}{}", ended, missing_.size(), trials_[i].setting->label(),
                       trials_[i].seed, outcome, ended < missing_.size() ? "; " + duration_label(left) + " left" : "");
  }

  Laboratory& lab_;
  const std::vector<Trial>& trials_;
  std::vector<Record> records_;
  std::vector<std::filesystem::path> paths_;  ///< of the trials' results, without ending
  std::vector<std::vector<std::string>> arguments_;
  std::vector<std::size_t> missing_;
  std::size_t outdated_ = 0, ended_ = 0;
  Clock::time_point begin_ = Clock::now();
};

Laboratory::Laboratory(LaboratoryOptions options)
    : options_(std::move(options)), program_hash_(hash_of(read_file(options_.program))) {
  check_writable(options_.folder / "runs");
}

std::vector<Record> Laboratory::run(const Subject& subject, const std::vector<Trial>& trials) {
  return Batch(*this, subject, trials).go();
}

}  // namespace moraine::study
