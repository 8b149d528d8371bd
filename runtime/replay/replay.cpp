// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "runtime/balance/decision.hpp"
#include "runtime/balance/initial_owners.hpp"
#include "runtime/balance/load_model.hpp"
#include "runtime/balance/registry.hpp"

namespace moraine::runtime {
namespace {

/// All ranks learn something from all.
double talk(const Machine& machine) { return 2 * std::ceil(std::log2(machine.ranks)) * machine.latency; }

/// Seconds.
struct Balancing {
  double collecting = 0, moving = 0;
};

/// Owners from epoch to epoch, by the code that balances runs.
class Balance {
 public:
  Balance(const Workload& work, const ReplayOptions& options)
      : work_(work),
        options_(options),
        row_(find_balancer(options.balancer)),
        predictor_(find_predictor(options.predictor)),
        balancer_(row_.make({})),
        histories_(work.sub_models * options.copies) {}

  /// What an epoch cost. The work counted at its end is what the next one is predicted to cost.
  void note(std::size_t place, const RecordedModel& model, const ClusterRun& run) {
    const WorkEpoch& next = work_.epochs[std::min(place + 1, work_.epochs.size() - 1)];
    const auto rounds = static_cast<double>(work_.epochs[place].span.rounds);
    load_.resize(model.size());
    for (SubModelId id = 0; id < model.size(); ++id)
      load_[id] += options_.balance_measured ? run.seconds[id] : counted(next, id) * rounds;
    rounds_ += rounds;
    note_traffic(model);
  }

  /// What it takes; `owner` may change.
  Balancing settle(const WorkEpoch& epoch, const RecordedModel& model, Owners& owner, Prediction& out) {
    const std::int64_t round = epoch.span.first_round;
    if (options_.machine.ranks == 1 || rounds_ == 0 || round < last_round_ + options_.balance_every) return {};
    last_round_ = round;
    for (SubModelId id = 0; id < load_.size(); ++id) histories_[id].add(load_[id] / rounds_);
    const auto begin = std::chrono::steady_clock::now();
    const BalanceDecision decision = decide(problem(model, owner), *balancer_, row_.forced);
    out.planning += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++turn_;
    ++out.balance_rounds;
    load_.assign(load_.size(), 0.0);
    rounds_ = 0;
    if (!decision.worthwhile) return {talk(options_.machine), 0};
    owner = decision.plan;
    out.migrations += decision.moves;
    out.moved_bytes += decision.bytes;
    return {talk(options_.machine), decision.cost_seconds};
  }

 private:
  double counted(const WorkEpoch& epoch, SubModelId id) const {
    const auto first = epoch.cost.begin() + static_cast<std::ptrdiff_t>(id % work_.sub_models * work_.stages());
    return std::accumulate(first, first + static_cast<std::ptrdiff_t>(work_.stages()), 0.0);
  }

  void note_traffic(const RecordedModel& model) {
    std::map<std::pair<SubModelId, SubModelId>, double> pairs;
    for (const SizedMessage& m : model.messages())
      if (m.message.from != m.message.to) pairs[std::minmax(m.message.from, m.message.to)] += m.bytes;
    traffic_.clear();
    for (const auto& [pair, bytes] : pairs) traffic_.push_back({pair.first, pair.second, bytes});
  }

  BalanceProblem problem(const RecordedModel& model, const Owners& owner) const {
    BalanceProblem p;
    for (SubModelId id = 0; id < model.size(); ++id) {
      p.load.push_back(predictor_.predict(histories_[id].loads()));
      p.bytes.push_back(model.memory(id));
    }
    p.traffic = traffic_;
    p.owner = owner;
    p.speed.assign(static_cast<std::size_t>(options_.machine.ranks), 1.0);
    p.turn = turn_;
    p.costs = costs_of(options_.balance_measured, options_.balance_every);
    return p;
  }

  const Workload& work_;
  const ReplayOptions& options_;
  const BalancerRow& row_;
  const PredictorRow& predictor_;
  std::unique_ptr<Balancer> balancer_;
  std::vector<LoadHistory> histories_;
  std::vector<double> load_;  ///< since the last look
  std::vector<Traffic> traffic_;
  double rounds_ = 0;
  std::int64_t last_round_ = 0, turn_ = 0;
};

double& of(std::array<double, phase_count>& phases, Phase phase) { return phases[static_cast<std::size_t>(phase)]; }

std::size_t most_held(const Owners& owners, int ranks) {
  std::vector<std::size_t> held(static_cast<std::size_t>(ranks), 0);
  for (const int owner : owners) ++held[static_cast<std::size_t>(owner)];
  return *std::ranges::max_element(held);
}

class Replay {
 public:
  Replay(const Workload& work, const ReplayOptions& options)
      : work_(work),
        options_(options),
        balance_(work, options),
        same_ranks_(options.copies == 1 && options.machine.ranks == work.settings.ranks()) {}

  Prediction run() {
    Owners owner = first_owners();
    for (std::size_t i = 0; i < work_.epochs.size(); ++i) {
      const WorkEpoch& epoch = work_.epochs[i];
      RecordedModel model(work_, epoch, options_.copies);
      const Balancing balancing = balance_.settle(epoch, model, owner, out_);
      model.share_out(owner, options_.machine.ranks);
      const ClusterRun run = simulate(model, options_.machine, epoch.span.rounds_with_opening());
      balance_.note(i, model, run);
      add(run);
      add_between(epoch, owner, balancing);
    }
    close();
    return out_;
  }

 private:
  Owners first_owners() const {
    std::vector<double> load(work_.sub_models * options_.copies, 1.0);
    if (same_ranks_ && !options_.initial_by_cost) return work_.epochs.front().owner;
    for (std::size_t id = 0; id < load.size() && options_.initial_by_cost; ++id) {
      const auto first =
          work_.epochs.front().cost.begin() + static_cast<std::ptrdiff_t>(id % work_.sub_models * work_.stages());
      load[id] = std::accumulate(first, first + static_cast<std::ptrdiff_t>(work_.stages()), 0.0);
    }
    return initial_owners(load, std::vector<double>(static_cast<std::size_t>(options_.machine.ranks), 1.0));
  }

  void add(const ClusterRun& run) {
    const double work = std::accumulate(run.busy.begin(), run.busy.end(), 0.0);
    out_.work += work;
    out_.tasks_span += run.elapsed;
    out_.messages += run.messages;
    out_.bytes += run.bytes;
    out_.tasks += run.tasks;
    const double even = work / static_cast<double>(run.busy.size());
    weighted_imbalance_ += even > 0 ? run.elapsed * *std::ranges::max_element(run.busy) / even : run.elapsed;
  }

  void add_between(const WorkEpoch& epoch, const Owners& owner, const Balancing& balancing) {
    auto phases = epoch.between.phase;
    const bool traced = same_ranks_ && options_.balancer == work_.settings.balancer;
    if (!traced) of(phases, Phase::balance) = collecting(epoch, balancing) + balancing.moving;
    if (!same_ranks_) {
      const double held = static_cast<double>(most_held(owner, options_.machine.ranks)) /
                          static_cast<double>(most_held(epoch.owner, work_.settings.ranks()));
      for (const Phase p : {Phase::settle, Phase::plan, Phase::checkpoint}) of(phases, p) *= held;
      of(phases, Phase::output) *= static_cast<double>(options_.copies);
      of(phases, Phase::agree) = talk(options_.machine);
    }
    out_.balancing += of(phases, Phase::balance);
    out_.between += std::accumulate(phases.begin(), phases.end(), 0.0) - of(phases, Phase::balance);
  }

  /// As many ranks as traced collect in the time it took, whatever is made of it.
  double collecting(const WorkEpoch& epoch, const Balancing& balancing) const {
    const double took = epoch.between.phase[static_cast<std::size_t>(Phase::balance)];
    return same_ranks_ ? std::max(0.0, took - epoch.moving) : balancing.collecting;
  }

  void close() {
    const double capacity = options_.machine.capacity();
    out_.makespan = out_.tasks_span + out_.between + out_.balancing;
    if (out_.makespan > 0) out_.utilisation = out_.work / (out_.makespan * capacity);
    if (out_.tasks_span > 0) {
      out_.tasks_utilisation = out_.work / (out_.tasks_span * capacity);
      out_.imbalance = weighted_imbalance_ / out_.tasks_span;
    }
  }

  const Workload& work_;
  const ReplayOptions& options_;
  Balance balance_;
  bool same_ranks_;
  double weighted_imbalance_ = 0;
  Prediction out_;
};

void check(const ReplayOptions& o) {
  const Machine& m = o.machine;
  if (m.ranks < 1 || m.threads < 1 || o.copies < 1)
    throw std::invalid_argument("ranks, threads and copies must be 1 or more");
  if (m.cores < 0 || !(m.latency >= 0) || !(m.bandwidth > 0) || !(m.speed > 0))
    throw std::invalid_argument("cores and latency must not be negative, bandwidth and speed be more than 0");
}

}  // namespace

ReplayOptions as_traced(const Workload& work) {
  const TraceSettings& s = work.settings;
  ReplayOptions o;
  o.machine.ranks = s.ranks();
  o.machine.threads = s.threads.empty() ? 1 : s.threads.front();
  o.machine.cores = work.shares_cores() ? std::max(1, static_cast<int>(std::lround(s.all_cores()))) : 0;
  o.machine.scheduler = s.scheduler;
  o.machine.latency = work.overheads.message > 0 ? work.overheads.message : Machine{}.latency;
  o.machine.overheads = work.overheads;
  o.balancer = s.balancer;
  o.predictor = s.predictor;
  o.balance_every = s.balance_every;
  o.balance_measured = s.balance_measured;
  return o;
}

Prediction replay(const Workload& work, const ReplayOptions& options) {
  check(options);
  return Replay(work, options).run();
}

}  // namespace moraine::runtime
