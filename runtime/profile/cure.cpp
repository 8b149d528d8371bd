// SPDX-License-Identifier: Apache-2.0
#include "runtime/profile/cure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/balance/registry.hpp"
#include "runtime/replay/rearrange.hpp"
#include "runtime/schedule/registry.hpp"

namespace moraine::runtime {
namespace {

constexpr double same = 0.01;  // gains that differ by less are the same

/// Collects what may be changed, one thing at a time.
class Candidates {
 public:
  Candidates(const Workload& work, const CureSearch& search)
      : work_(work), cores_(search.cores), base_{.options = as_traced(work)} {}

  std::vector<Cure> all() {
    schedulers_and_balancers();
    if (phase_share(Phase::output) > Cures::least_gain) add({.change = Change::less_output, .options = base_.options});
    layouts();
    for (const std::size_t pieces : {2, 4, 8})
      add({.change = Change::finer_cut, .options = base_.options, .pieces = pieces});
    return std::move(out_);
  }

 private:
  void add(const Cure& cure) { out_.push_back(cure); }

  void schedulers_and_balancers() {
    const Machine& now = base_.options.machine;
    for (const SchedulerRow& row : schedulers()) {
      Cure cure{.change = Change::scheduler, .options = base_.options};
      cure.options.machine.scheduler = row.name;
      if (row.name != now.scheduler) add(cure);
    }
    for (const BalancerRow& row : balancers()) {
      Cure cure{.change = Change::balancer, .options = base_.options};
      cure.options.balancer = row.name;
      if (now.ranks > 1 && row.name != base_.options.balancer && !row.forced) add(cure);
    }
  }

  void layouts() {
    const auto [ranks, threads] = std::pair(base_.options.machine.ranks, base_.options.machine.threads);
    const int workers = ranks * threads;
    std::set<std::pair<int, int>> layouts{
        {2 * ranks, threads}, {ranks, 2 * threads}, {ranks, std::max(1, threads / 2)}};
    layouts.insert({std::max(1, ranks / 2), threads});
    layouts.insert({ranks, std::max(1, static_cast<int>(cores_) / ranks)});
    for (int r = 1; r <= workers; ++r)
      if (workers % r == 0) layouts.insert({r, workers / r});
    for (const auto& [r, t] : layouts)
      if (std::pair(r, t) != std::pair(ranks, threads) && r <= std::ssize(work_.epochs.front().owner)) layout(r, t);
  }

  void layout(int ranks, int threads) {
    Cure cure{.change = Change::layout, .options = base_.options};
    cure.options.machine.ranks = ranks;
    cure.options.machine.threads = threads;
    cure.fits = ranks * threads <= cores_;
    if (!cure.fits) cure.options.machine.cores = 0;
    add(cure);
  }

  double phase_share(Phase phase) const {
    double seconds = 0;
    for (const WorkEpoch& e : work_.epochs) seconds += e.between.phase[static_cast<std::size_t>(phase)];
    return work_.traced_makespan > 0 ? seconds / work_.traced_makespan : 0;
  }

  const Workload& work_;
  double cores_;
  Cure base_;
  std::vector<Cure> out_;
};

Workload with_less_output(Workload work) {
  for (WorkEpoch& e : work.epochs) e.between.phase[static_cast<std::size_t>(Phase::output)] /= 4;
  return work;
}

Prediction predict(const Workload& work, const CureSearch& search, const Cure& cure) {
  if (cure.change == Change::finer_cut) return replay(cut_finer(work, cure.pieces, search.halo), cure.options);
  if (cure.change == Change::less_output) return replay(with_less_output(work), cure.options);
  return replay(work, cure.options);
}

std::optional<std::size_t> best_of(const std::vector<Cure>& tried) {
  double most = Cures::least_gain;
  for (const Cure& c : tried)
    if (c.fits) most = std::max(most, c.gain);
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const Cure& c = tried[i];
    if (!c.fits || c.gain < std::max(most - same, Cures::least_gain)) continue;
    const auto rank = [](const Cure& cure) { return std::pair(cure.change, -cure.gain); };
    if (!best || rank(c) < rank(tried[*best])) best = i;
  }
  return best;
}

}  // namespace

Cures find_cures(const Workload& work, const CureSearch& search) {
  Cures out{.now = replay(work, as_traced(work)), .tried = Candidates(work, search).all(), .best = {}};
  for (Cure& cure : out.tried) {
    search.progress(cure);
    cure.prediction = predict(work, search, cure);
    cure.gain = out.now.makespan > 0 ? 1 - cure.prediction.makespan / out.now.makespan : 0;
  }
  out.best = best_of(out.tried);
  return out;
}

std::string words(const Cure& cure, const Workload& work) {
  const Machine& m = cure.options.machine;
  switch (cure.change) {
    case Change::scheduler:
      return "--scheduler " + m.scheduler;
    case Change::balancer:
      return "--balancer " + cure.options.balancer;
    case Change::less_output:
      return "a larger --output-every: a quarter of the time for frames";
    case Change::layout:
      return fmt::format("{} rank{} x {} thread{}", m.ranks, m.ranks == 1 ? "" : "s", m.threads,
                         m.threads == 1 ? "" : "s");
    case Change::finer_cut:
      break;
  }
  return fmt::format("--sub-models {}", work.sub_models * cure.pieces);
}

}  // namespace moraine::runtime
