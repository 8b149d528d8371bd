// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <chrono>
#include <iostream>

#include "output/file.hpp"
#include "output/label.hpp"
#include "physics/errors.hpp"
#include "physics/plugin.hpp"
#include "study/process.hpp"

namespace moraine::study {
namespace {

using Clock = std::chrono::steady_clock;

std::string hash_of(std::string_view text) { return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size())); }

/// Of the program and of the engines' libraries that it would load.
std::string hash_of_program(const std::filesystem::path& program) {
  std::string all = read_file(program);
  for (const Engine& engine : engines())
    if (const auto library = find_plugin(engine.name)) all += read_file(*library);
  return hash_of(all);
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
  Batch(Laboratory& lab, const Subject& subject, const std::vector<Trial>& trials)
      : lab_(lab), subject_(subject), trials_(trials) {
    for (const Trial& t : trials) prepare(t);
  }

  std::vector<Record> go() {
    announce();
    std::vector<Process> processes;
    for (const std::size_t i : missing_) processes.push_back(process(i));
    run_all(processes, lab_.options_.at_once, [&](std::size_t k, int status) { finish(missing_[k], status); });
    return std::move(records_);
  }

 private:
  void prepare(const Trial& t) {
    const Record r = begun(*t.setting, t.seed, lab_.program_hash_);
    const std::filesystem::path path = lab_.options_.folder / "runs" / (t.setting->engine + "-" + hash_of(r.command));
    const std::optional<Record> found = read_record(path.string() + ".json");
    const bool same = found && found->identity == r.identity && found->at_once == r.at_once;
    if (found && !same) ++outdated_;
    const bool usable = same && found->final();
    if (!usable) missing_.push_back(records_.size());
    records_.push_back(usable ? *found : r);
    paths_.push_back(path);
    arguments_.push_back(arguments(subject_.file(), overrides(*t.setting, t.seed), path));
  }

  Record begun(const Setting& setting, int seed, const std::string& program) const {
    Record r;
    r.command = command_line(subject_.file(), overrides(setting, seed));
    r.identity = setting.identity + "-" + program;
    r.at_once = lab_.options_.at_once;
    return r;
  }

  std::vector<Override> overrides(const Setting& setting, int seed) const {
    std::vector<Override> all = subject_.overrides(setting, seed);
    all.push_back({"run.threads", std::to_string(lab_.options_.threads), "the study"});
    return all;
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
      say(
          fmt::format("{} finished runs are of another version of the scene or the program, or were not made {} at a "
                      "time; they are repeated",
                      outdated_, lab_.options_.at_once));
    const std::size_t found = trials_.size() - missing_.size();
    if (found > 0) say(fmt::format("{} of {} runs are there already", found, trials_.size()));
  }

  /// A run that began with another scene or program than the study must not pass for one of it.
  void check_unchanged(std::size_t i) const {
    const Setting setting = subject_.resolve(trials_[i].setting->choices);
    const Record now = begun(setting, trials_[i].seed, hash_of_program(lab_.options_.program));
    if (now.identity != records_[i].identity || now.command != records_[i].command)
      throw InputError(
          fmt::format("{}: the scene or the program has changed since the study began; begin it again, "
                      "what it had finished before is kept",
                      subject_.file()));
  }

  void finish(std::size_t i, int status) {
    check_unchanged(i);
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
  const Subject& subject_;
  const std::vector<Trial>& trials_;
  std::vector<Record> records_;
  std::vector<std::filesystem::path> paths_;  ///< of the trials' results, without ending
  std::vector<std::vector<std::string>> arguments_;
  std::vector<std::size_t> missing_;
  std::size_t outdated_ = 0, ended_ = 0;
  Clock::time_point begin_ = Clock::now();
};

Laboratory::Laboratory(LaboratoryOptions options)
    : options_(std::move(options)), lock_(options_.folder), program_hash_(hash_of_program(options_.program)) {
  make_folder(options_.folder / "runs");
}

std::vector<Record> Laboratory::run(const Subject& subject, const std::vector<Trial>& trials) {
  return Batch(*this, subject, trials).go();
}

}  // namespace moraine::study
