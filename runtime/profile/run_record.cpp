// SPDX-License-Identifier: Apache-2.0
#include "runtime/profile/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "runtime/records.hpp"

namespace moraine::runtime {
namespace {

constexpr double enough_tasks = 20'000;
constexpr double least_epochs = 4, least_rounds = 4;

/// A sub-model, told by its owner.
struct Told {
  SubModelId id = 0;
  RunRecord::Counters counters{};
  double memory = 0;
};

template <class Record>
std::vector<Record> gathered(Transport& transport, const std::vector<Record>& own) {
  Bytes bytes;
  write_records(bytes, own);
  std::vector<Record> all;
  for (const Bytes& b : transport.gather(0, bytes)) {
    std::span<const std::byte> in(b);
    const auto records = read_records<Record>(in);
    all.insert(all.end(), records.begin(), records.end());
  }
  return all;
}

void gather_sub_models(Simulation& simulation, RunRecord& out) {
  Model& model = simulation.model();
  const std::size_t stages = model.stages().size();
  std::vector<Told> told;
  std::vector<CostRecord> costs;
  for (const SubModelId id : model.held()) {
    SubModel& s = model.sub_model(id);
    s.count(told.emplace_back(Told{.id = id, .memory = s.memory()}).counters);
    for (std::size_t stage = 0; stage < stages; ++stage)
      costs.push_back({0, id, static_cast<std::int32_t>(stage), 0, s.counted_work(static_cast<int>(stage))});
  }
  out.memory.resize(model.size());
  out.counters.resize(model.size());
  out.cost.resize(model.size() * stages);
  for (const Told& t : gathered(simulation.transport(), told)) {
    out.memory[t.id] = t.memory;
    out.counters[t.id] = t.counters;
  }
  for (const CostRecord& c : gathered(simulation.transport(), costs))
    out.cost[c.sub_model * stages + static_cast<std::size_t>(c.stage)] = c.cost;
}

void gather_messages(Simulation& simulation, RunRecord& out) {
  for (const Mail::Sent& s : gathered(simulation.transport(), simulation.last_sent()))
    out.messages.push_back(
        {s.message, s.messages > 0 ? static_cast<double>(s.bytes) / static_cast<double>(s.messages) : 0.0});
  std::ranges::sort(out.messages, {}, &SizedMessage::message);
}

Between mean_between(const RunRecord& run) {
  Between out;
  for (std::size_t p = 0; p < phase_count; ++p) {
    for (const RankLoad& rank : run.ranks) out.phase[p] += rank.phases[p];
    out.phase[p] /= run.epochs * static_cast<double>(run.ranks.size());
  }
  out.phase[static_cast<std::size_t>(Phase::work)] = 0;
  out.phase[static_cast<std::size_t>(Phase::agree)] = 0;  // waiting for the last rank, for the most part
  return out;
}

double mean_overhead(const RunRecord& run) {
  double seconds = 0, tasks = 0;
  for (const RankLoad& rank : run.ranks) {
    for (const Wait& w : rank.load.waits) seconds += w.overhead;
    tasks += static_cast<double>(rank.load.tasks());
  }
  return seconds / tasks;
}

std::vector<double> mean_seconds(const RunRecord& run, std::size_t nodes) {
  std::vector<Busy> all(nodes);
  for (const RankLoad& rank : run.ranks)
    for (std::size_t n = 0; n < rank.load.nodes.size(); ++n)
      all.at(n).add(rank.load.nodes[n].taken, rank.load.nodes[n].tasks);
  std::vector<double> out;
  for (const Busy& b : all) out.push_back(b.tasks > 0 ? b.taken.seconds / static_cast<double>(b.tasks) : 0.0);
  return out;
}

}  // namespace

std::vector<double> RunRecord::seconds() const {
  std::vector<double> out(static_cast<std::size_t>(settings.sub_models), 0.0);
  for (const RankLoad& rank : ranks)
    for (SubModelId id = 0; id < out.size(); ++id) out[id] += rank.load.processor_of(id);
  return out;
}

RunRecord record_of(Simulation& simulation) {
  RunRecord out{.settings = simulation.settings(),
                .ranks = gather_loads({simulation.load(), simulation.phase_seconds()}, simulation.transport()),
                .owner = simulation.model().placement().owner,
                .rounds = static_cast<double>(simulation.rounds()),
                .epochs = simulation.messages().epochs};
  gather_sub_models(simulation, out);
  gather_messages(simulation, out);
  for (const RankLoad& rank : out.ranks) out.elapsed = std::max(out.elapsed, rank.elapsed());
  return out;
}

Workload typical_workload(const RunRecord& run) {
  Workload out{.settings = run.settings,
               .sub_models = static_cast<std::size_t>(run.settings.sub_models),
               .epochs = {},
               .overheads = {},
               .traced_makespan = run.elapsed};
  if (run.epochs < 1 || run.rounds < 1 || out.sub_models == 0) throw std::invalid_argument("nothing ran yet");
  out.overheads = {mean_overhead(run), mean_overhead(run), 0};
  const auto nodes = static_cast<double>(out.nodes());
  double rounds = std::max(1.0, std::round(run.rounds / run.epochs));
  const double epochs =
      std::clamp(std::floor(enough_tasks / (nodes * (rounds + 1))), std::min(least_epochs, run.epochs), run.epochs);
  rounds = std::clamp(std::floor(enough_tasks / (nodes * epochs)), std::min(least_rounds, rounds), rounds);
  WorkEpoch epoch{.span = {0, static_cast<std::int64_t>(rounds)},
                  .messages = run.messages,
                  .cost = run.cost,
                  .memory = run.memory,
                  .seconds = {},
                  .owner = run.owner,
                  .between = mean_between(run),
                  .moving = 0,
                  .traced_seconds = run.elapsed / run.epochs};
  const std::vector<double> seconds = mean_seconds(run, out.nodes());
  for (std::int64_t round = 0; round <= epoch.span.rounds; ++round)
    epoch.seconds.insert(epoch.seconds.end(), seconds.begin(), seconds.end());
  // Less of an epoch's rounds, less of what happens between epochs.
  for (double& phase : epoch.between.phase) phase *= rounds / std::max(1.0, run.rounds / run.epochs);
  for (std::int64_t e = 0; e < static_cast<std::int64_t>(epochs); ++e) {
    epoch.span.first_round = e * epoch.span.rounds;
    out.epochs.push_back(epoch);
  }
  return out;
}

}  // namespace moraine::runtime
