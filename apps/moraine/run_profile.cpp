// SPDX-License-Identifier: Apache-2.0
#include "run_profile.hpp"

#include <algorithm>

#include "ghost_overhead.hpp"
#include "runtime/profile/profile.hpp"
#include "runtime/profile/run_record.hpp"
#include "runtime/profile/verdict.hpp"

namespace moraine::app {
namespace {

using runtime::Account;

constexpr std::size_t costliest_told = 3;
constexpr double worth_a_search = 0.02;  // of the time of workers, not at tasks

Summary::Profile::Share share_of(std::span<const Account> ranks, double Account::*what) {
  std::vector<double> shares;
  for (const Account& a : ranks) shares.push_back(a.share(a.*what));
  const runtime::Range r = runtime::range_of(shares);
  return {r.min, r.mean, r.max};
}

std::optional<runtime::Advice> advice_for(const runtime::RunRecord& run, const std::vector<double>& seconds) {
  std::vector<Counters> counters;
  for (const runtime::RunRecord::Counters& c : run.counters) std::ranges::copy(c, counters.emplace_back().begin());
  const runtime::Workload work = runtime::typical_workload(run);
  const runtime::CureSearch search{.cores = run.settings.all_cores(),
                                   .halo = ghost_overhead(run.settings, counters, seconds).halo()};
  return runtime::advice_of(runtime::find_cures(work, search), work);
}

std::vector<Summary::Profile::Costly> costliest(const std::vector<double>& seconds) {
  std::vector<Summary::Profile::Costly> out;
  double sum = 0;
  for (std::uint32_t id = 0; id < seconds.size(); ++id) {
    out.push_back({id, seconds[id]});
    sum += seconds[id];
  }
  std::ranges::stable_sort(out, std::greater<>(), &Summary::Profile::Costly::share);
  out.resize(std::min(out.size(), costliest_told));
  for (auto& c : out) c.share = sum > 0 ? c.share / sum : 0;
  return out;
}

}  // namespace

Summary::Profile profile_of(runtime::Simulation& simulation) {
  const runtime::RunRecord run = runtime::record_of(simulation);
  if (run.ranks.empty() || run.rounds < 1) return {};
  const std::vector<Account> ranks = runtime::accounts_of(run.ranks);
  const Account all = runtime::sum(ranks);
  const std::vector<double> seconds = run.seconds();
  Summary::Profile out;
  out.busy = share_of(ranks, &Account::busy);
  out.imbalance = share_of(ranks, &Account::imbalance);
  out.messages = share_of(ranks, &Account::messages);
  out.scheduling = share_of(ranks, &Account::scheduling);
  out.between = share_of(ranks, &Account::between);
  out.costliest = costliest(seconds);
  std::optional<runtime::Advice> advice;
  if (1 - all.share(all.busy) > worth_a_search) advice = advice_for(run, seconds);
  if (advice) out.cure = {advice->words, advice->gain};
  out.sentence = runtime::sentence(all, runtime::culprit_of(seconds, {}), advice);
  return out;
}

}  // namespace moraine::app
