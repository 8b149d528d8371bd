// SPDX-License-Identifier: Apache-2.0
#include "runtime/profile/profile.hpp"

#include <map>
#include <numeric>
#include <set>

#include "runtime/profile/parts.hpp"
#include "runtime/trace/trace_file.hpp"

namespace moraine::runtime {
namespace {

double max_over_mean(std::span<const double> values) {
  const Range r = range_of(values);
  return r.mean > 0 ? r.max / r.mean : 1.0;
}

/// From the first rank's begin to the last one's end, summed over epochs.
double elapsed_of(const Trace& trace) {
  std::map<std::uint32_t, std::pair<double, double>> spans;
  for (const PhaseRecord& p : trace.lists.phases) {
    auto& [begin, end] = spans.try_emplace(p.epoch, p.start, p.end).first->second;
    begin = std::min(begin, p.start);
    end = std::max(end, p.end);
  }
  double sum = 0;
  for (const auto& [epoch, span] : spans) sum += span.second - span.first;
  return sum;
}

std::vector<StageProfile> stages_of(const Trace& trace, std::span<const RankLoad> loads) {
  std::vector<StageProfile> out(trace.settings.stages.size());
  std::vector<std::vector<double>> tasks(out.size());
  for (const TaskRecord& t : trace.lists.tasks) tasks.at(static_cast<std::size_t>(t.stage)).push_back(t.seconds());
  for (std::size_t s = 0; s < out.size(); ++s) {
    std::vector<double> ranks;
    for (const RankLoad& load : loads) ranks.push_back(load.load.stages.at(s).taken.seconds);
    out[s] = {std::accumulate(ranks.begin(), ranks.end(), 0.0), static_cast<std::int64_t>(tasks[s].size()),
              range_of(tasks[s]), range_of(ranks)};
  }
  return out;
}

std::vector<SubModelProfile> sub_models_of(const Trace& trace) {
  std::vector<SubModelProfile> out(static_cast<std::size_t>(trace.settings.sub_models));
  std::vector<double> tasks(out.size(), 0.0);
  for (std::size_t id = 0; id < out.size(); ++id) out[id].id = static_cast<std::uint32_t>(id);
  for (const TaskRecord& t : trace.lists.tasks) {
    SubModelProfile& s = out.at(t.sub_model);
    s.seconds += t.seconds();
    ++tasks[t.sub_model];
    for (std::size_t c = 0; c < s.counters.size(); ++c) s.counters[c] += t.counters[c];
  }
  for (SubModelProfile& s : out)
    for (double& c : s.counters) c /= std::max(1.0, tasks[s.id]);
  for (const MoveRecord& m : trace.lists.moves) ++out.at(m.sub_model).moves;
  return out;
}

std::vector<EpochLoad> epoch_loads(const Trace& trace) {
  std::map<std::uint32_t, EpochLoad> epochs;
  for (const TaskRecord& t : trace.lists.tasks) {
    EpochLoad& e = epochs.try_emplace(t.epoch, EpochLoad{t.epoch, t.start, t.end, {}}).first->second;
    e.busy.resize(static_cast<std::size_t>(trace.settings.ranks()));
    e.busy.at(static_cast<std::size_t>(t.rank)) += t.seconds();
    e.start = std::min(e.start, t.start);
    e.end = std::max(e.end, t.end);
  }
  std::vector<EpochLoad> out;
  for (auto& [number, epoch] : epochs) out.push_back(std::move(epoch));
  return out;
}

Communication communication_of(const Trace& trace) {
  Communication out;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> owner;
  for (const OwnerRecord& o : trace.lists.owners) owner[{o.epoch, o.sub_model}] = o.rank;
  std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> pairs;
  for (const MessageRecord& m : trace.lists.messages) {
    out.messages += static_cast<double>(m.messages);
    out.bytes += static_cast<double>(m.bytes);
    pairs.insert({m.epoch, m.from, m.to});
    if (owner[{m.epoch, m.from}] == owner[{m.epoch, m.to}]) continue;
    out.messages_between += static_cast<double>(m.messages);
    out.bytes_between += static_cast<double>(m.bytes);
  }
  out.pairs = std::ssize(pairs) / std::max<std::int64_t>(1, std::ssize(trace.lists.epochs));
  std::vector<double> ways;
  for (const TaskRecord& t : trace.lists.tasks)
    if (t.release == Release::message) ways.push_back(t.ready - t.sent);
  out.on_their_way = range_of(ways).mean;
  return out;
}

/// What the epoch that begins with new owners gained by them, in each of its kind.
double gain_per_epoch(const std::vector<EpochLoad>& epochs, std::size_t at) {
  if (at == 0 || at >= epochs.size()) return 0;
  return range_of(epochs[at].busy).mean * (epochs[at - 1].imbalance() - epochs[at].imbalance());
}

BalanceProfile balance_of(const Trace& trace, std::span<const RankLoad> loads, const std::vector<EpochLoad>& epochs) {
  BalanceProfile out;
  for (const RankLoad& load : loads) out.seconds = std::max(out.seconds, load.phase(Phase::balance));
  const auto place = [&](std::uint32_t epoch) {
    return static_cast<std::size_t>(std::ranges::lower_bound(epochs, epoch, {}, &EpochLoad::epoch) - epochs.begin());
  };
  double gain_of_one = 0;
  std::size_t since = 0;
  for (const BalanceRoundRecord& b : trace.lists.balance) {
    ++out.rounds;
    if (b.carried_out == 0) continue;
    out.gain += gain_of_one * static_cast<double>(place(b.epoch) - since);
    since = place(b.epoch);
    gain_of_one = gain_per_epoch(epochs, since);
    ++out.carried_out;
    out.moves += b.moves;
    out.bytes += b.moved_bytes;
    out.forecast_gain += b.gain_seconds;
  }
  out.gain += gain_of_one * static_cast<double>(epochs.size() - since);
  return out;
}

}  // namespace

Range range_of(std::span<const double> values) {
  if (values.empty()) return {};
  const auto [min, max] = std::ranges::minmax(values);
  return {min, std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()), max};
}

double EpochLoad::imbalance() const { return max_over_mean(busy); }

double Profile::imbalance() const {
  std::vector<double> busy;
  for (const Account& a : ranks) busy.push_back(a.busy);
  return max_over_mean(busy);
}

std::vector<std::size_t> Profile::most(double SubModelProfile::*what, std::size_t count) const {
  std::vector<std::size_t> places(sub_models.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::ranges::stable_sort(places, std::greater<>(), [&](std::size_t at) { return sub_models[at].*what; });
  places.resize(std::min(count, places.size()));
  return places;
}

Profile profile_of(const Trace& trace) {
  if (trace.lists.tasks.empty()) throw TraceError("the trace holds no task, expected one at least");
  const std::vector<RankLoad> loads = loads_of(trace);
  const Chains chains(trace);
  Profile p;
  p.elapsed = elapsed_of(trace);
  p.ranks = accounts_of(loads);
  p.all = sum(p.ranks);
  p.stages = stages_of(trace, loads);
  p.sub_models = sub_models_of(trace);
  p.epochs = epoch_loads(trace);
  p.communication = communication_of(trace);
  p.balance = balance_of(trace, loads, p.epochs);
  p.path = critical_path(trace, chains, p.elapsed);
  for (const Segment& s : p.path.segments)
    if (s.on == SpentOn::task) p.sub_models[s.task->sub_model].on_path += s.seconds();
  p.waits = who_waited(trace, chains, p.sub_models);
  return p;
}

}  // namespace moraine::runtime
