// SPDX-License-Identifier: Apache-2.0
#include "study/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "physics/errors.hpp"
#include "study/halving.hpp"

namespace moraine::study {
namespace {

constexpr std::size_t least_looked_at = 4;
constexpr int first_look = 2;  ///< fresh seeds that suffice to reject
constexpr int fresh_after = 1000;

Candidate candidate_of(const Row& row) { return {row.speed > 0 ? 1 / row.speed : 0, row.good(), row.error}; }

/// The scene or its proxy, with what results are compared with.
class Stage {
 public:
  Stage(const Subject& subject, Laboratory& laboratory, const TuningOptions& options)
      : subject_(subject), laboratory_(laboratory), options_(options) {
    compare_with(options.seeds);
  }

  void compare_with(int seeds) {
    if (seeds <= reference_seeds()) return;
    reference_runs_ = run_reference(subject_, laboratory_, options_.first_seed, seeds);
    yardstick_.emplace(subject_.scene(), reference_runs_);
  }

  int reference_seeds() const { return static_cast<int>(reference_runs_.size()); }

  std::optional<Row> reference() const {
    if (reference_runs_.empty()) return std::nullopt;
    return make_row(subject_.resolve(subject_.reference()), reference_runs_, *yardstick_, options_.seconds);
  }

  std::optional<double> noise() const { return yardstick_->noise(); }
  const Subject& subject() const { return subject_; }

  Row measure(const Setting& setting, int first_seed, int seeds) {
    return make_row(setting, laboratory_.run(subject_, trials_of(setting, first_seed, seeds)), *yardstick_,
                    options_.seconds);
  }

  /// All at once, so that all cores have work.
  std::vector<Row> measure(const std::vector<Setting>& settings, int first_seed, int seeds) {
    std::vector<Trial> trials;
    for (const Setting& s : settings)
      for (const Trial& t : trials_of(s, first_seed, seeds)) trials.push_back(t);
    const std::vector<Record> records = laboratory_.run(subject_, trials);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < settings.size(); ++i)
      rows.push_back(make_row(
          settings[i], std::span(records).subspan(i * static_cast<std::size_t>(seeds), static_cast<std::size_t>(seeds)),
          *yardstick_, options_.seconds));
    return rows;
  }

 private:
  const Subject& subject_;
  Laboratory& laboratory_;
  const TuningOptions& options_;
  std::vector<Record> reference_runs_;
  std::optional<Yardstick> yardstick_;
};

std::vector<std::size_t> plausible_rows(const std::vector<Row>& rows, double wish) {
  std::vector<Candidate> candidates;
  for (const Row& row : rows) candidates.push_back(candidate_of(row));
  return plausible(candidates, wish);
}

/// The settings that may be good enough, cheapest first.
std::vector<Setting> screen(Stage& stage, const std::vector<Setting>& settings, double wish,
                            const TuningOptions& options, Tuned& tuned) {
  std::vector<Row> rows = stage.measure(settings, options.first_seed, 1);
  std::vector<std::size_t> left = plausible_rows(rows, wish);
  left.resize(half_of(left.size(), least_looked_at));
  std::vector<Setting> closer;
  for (const std::size_t i : left) closer.push_back(settings[i]);
  const std::vector<Row> again = stage.measure(closer, options.first_seed, options.seeds);
  for (std::size_t k = 0; k < left.size(); ++k) rows[left[k]] = again[k];
  std::vector<Setting> kept;
  for (const std::size_t i : plausible_rows(rows, wish)) kept.push_back(settings[i]);
  tuned.failed =
      static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const Row& r) { return !r.good(); }));
  tuned.refuted = rows.size() - tuned.failed - kept.size();
  return kept;
}

/// Runs a candidate with fresh seeds until it is judged.
Step::Kind judge(Stage& stage, const Setting& setting, const TuningOptions& options, Row& row) {
  int seeds = std::min(first_look, options.fresh_seeds);
  while (true) {
    row = stage.measure(setting, options.first_seed + fresh_after, seeds);
    if (!row.good()) return Step::Kind::reject;
    const Step step = next_step(row.counted, options.wish, seeds, options.fresh_seeds, options.most_seeds);
    const bool both = step.kind == Step::Kind::more_of_both;
    if (step.kind != Step::Kind::more_seeds && !both) return step.kind;
    if (step.seeds <= seeds && (!both || step.seeds <= stage.reference_seeds())) return Step::Kind::give_up;
    if (both) stage.compare_with(step.seeds);
    seeds = std::max(seeds, step.seeds);
  }
}

void confirm(Stage& stage, const std::vector<Setting>& candidates, const TuningOptions& options, Tuned& tuned) {
  std::vector<Row> rows(candidates.size());
  const auto verdicts = first_accepted(
      candidates.size(),
      [&](std::size_t i) { return judge(stage, stage.subject().resolve(candidates[i].choices), options, rows[i]); },
      [&] { return stage.reference_seeds(); });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (verdicts[i] == Step::Kind::accept)
      tuned.found = rows[i];
    else if (verdicts[i])
      (verdicts[i] == Step::Kind::reject ? tuned.too_bad : tuned.undecided).push_back(rows[i]);
  }
}

}  // namespace

std::vector<Trial> trials_of(const Setting& setting, int first_seed, int seeds) {
  std::vector<Trial> trials;
  for (int k = 0; k < seeds; ++k) trials.push_back({&setting, first_seed + k});
  return trials;
}

std::vector<Record> run_reference(const Subject& subject, Laboratory& laboratory, int first_seed, int seeds) {
  if (!Yardstick::needs_reference(subject.scene())) return {};
  const Setting setting = subject.resolve(subject.reference());
  std::vector<Record> records = laboratory.run(subject, trials_of(setting, first_seed, seeds));
  for (const Record& r : records)
    if (!r.good()) throw InputError(fmt::format("the reference failed: {}\n  {}", r.message, r.command));
  if (alike(records))
    throw InputError(fmt::format("the reference failed: {}\n  {}", seeds_change_nothing, records.front().command));
  return records;
}

Tuned tune(const Subject& subject, const std::vector<AxisBlock>& grid, Laboratory& laboratory,
           const TuningOptions& options) {
  Tuned tuned;
  const Subject small = subject.proxy();
  const std::vector<Setting> settings = small.resolve(combinations(grid));
  tuned.candidates = settings.size();
  Stage screening(small, laboratory, options);
  const double loose = subject.has_proxy() && !options.proxy_only ? options.slack * options.wish : options.wish;
  const std::vector<Setting> left = screen(screening, settings, loose, options, tuned);
  tuned.on_proxy = subject.has_proxy() && options.proxy_only;
  Stage judging(tuned.on_proxy ? small : subject, laboratory, options);
  confirm(judging, left, options, tuned);
  tuned.reference = judging.reference();
  tuned.noise = judging.noise();
  return tuned;
}

}  // namespace moraine::study
