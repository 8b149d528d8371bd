// SPDX-License-Identifier: Apache-2.0
#include "runtime/profile/account.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "runtime/records.hpp"

namespace moraine::runtime {
namespace {

Account account_of(const RankLoad& rank, double least_agreeing) {
  const auto workers = static_cast<double>(rank.load.workers.size());
  Wait wait;
  for (const Wait& w : rank.load.waits) wait += w;
  Account a;
  a.busy = rank.load.busy();
  a.imbalance = wait.within + wait.among + workers * (rank.phase(Phase::agree) - least_agreeing);
  a.messages = wait.messages + workers * least_agreeing;
  const double told = a.busy + wait.total();
  a.scheduling = wait.held + wait.overhead + std::max(0.0, workers * rank.phase(Phase::work) - told);
  for (const Phase p : {Phase::settle, Phase::balance, Phase::checkpoint, Phase::plan, Phase::output})
    a.between += workers * rank.phase(p);
  return a;
}

/// The work phase of a rank's epoch, and the end of its last task.
struct Work {
  double begin = 0, end = 0, last = 0;
};

class LoadsOfTrace {
 public:
  explicit LoadsOfTrace(const Trace& trace) : trace_(trace), ranks_(static_cast<std::size_t>(trace.settings.ranks())) {
    const std::size_t stages = trace.settings.stages.size();
    for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
      LoadRecord& load = ranks_[rank].load;
      load.workers.resize(static_cast<std::size_t>(trace.settings.threads[rank]));
      load.waits.resize(load.workers.size());
      load.stages.resize(stages);
      load.nodes.resize(static_cast<std::size_t>(trace.settings.sub_models) * stages);
    }
  }

  std::vector<RankLoad> read() {
    for (const PhaseRecord& p : trace_.lists.phases) add(p);
    for (const TaskRecord& t : trace_.lists.tasks) add(t);
    for (const auto& [key, work] : work_) wait_for_the_end(key.second, key.first, work);
    return std::move(ranks_);
  }

 private:
  void add(const PhaseRecord& p) {
    RankLoad& rank = ranks_.at(static_cast<std::size_t>(p.rank));
    rank.phases[static_cast<std::size_t>(p.phase)] += p.seconds();
    if (p.phase != Phase::work) return;
    work_[{p.epoch, p.rank}] = {p.start, p.end, p.start};
    rank.load.elapsed += p.seconds();
  }

  /// Tasks of a worker come in the order of time.
  void add(const TaskRecord& t) {
    LoadRecord& load = ranks_.at(static_cast<std::size_t>(t.rank)).load;
    const Taken taken{t.seconds(), t.seconds()};
    load.workers.at(static_cast<std::size_t>(t.worker)).add(taken);
    load.stages.at(static_cast<std::size_t>(t.stage)).add(taken);
    load.nodes.at(t.sub_model * load.stages.size() + static_cast<std::size_t>(t.stage)).add(taken);
    Work& work = work_[{t.epoch, t.rank}];
    work.last = std::max(work.last, t.end);
    double& idle = idle_.try_emplace({t.epoch, t.rank, t.worker}, work.begin).first->second;
    const Released by{.by = t.release, .sent = t.sent, .ready = t.ready};
    load.waits[static_cast<std::size_t>(t.worker)] += wait_before(idle, by, t.handed, t.start);
    idle = t.end;
  }

  void wait_for_the_end(int rank, std::uint32_t epoch, const Work& work) {
    std::vector<Wait>& waits = ranks_[static_cast<std::size_t>(rank)].load.waits;
    for (std::size_t w = 0; w < waits.size(); ++w) {
      const auto idle = idle_.find({epoch, rank, static_cast<int>(w)});
      waits[w] += wait_after(idle == idle_.end() ? work.begin : idle->second, work.last, work.end);
    }
  }

  const Trace& trace_;
  std::vector<RankLoad> ranks_;
  std::map<std::pair<std::uint32_t, int>, Work> work_;          ///< by epoch and rank
  std::map<std::tuple<std::uint32_t, int, int>, double> idle_;  ///< since when, by epoch, rank and worker
};

struct Times {
  double working = 0;
  PhaseSeconds phases{};
};

Bytes pack(const RankLoad& rank) {
  Bytes out;
  write_records(out, rank.load.workers);
  write_records(out, rank.load.stages);
  write_records(out, rank.load.nodes);
  write_records(out, rank.load.waits);
  write_records(out, std::vector<Times>{{rank.load.elapsed, rank.phases}});
  return out;
}

RankLoad unpack(std::span<const std::byte> in) {
  RankLoad rank;
  for (auto* list : {&rank.load.workers, &rank.load.stages, &rank.load.nodes}) *list = read_records<Busy>(in);
  rank.load.waits = read_records<Wait>(in);
  const Times times = read_records<Times>(in).at(0);
  rank.load.elapsed = times.working;
  rank.phases = times.phases;
  return rank;
}

}  // namespace

double RankLoad::elapsed() const { return std::accumulate(phases.begin(), phases.end(), 0.0); }

Account& Account::operator+=(const Account& other) {
  busy += other.busy;
  imbalance += other.imbalance;
  messages += other.messages;
  scheduling += other.scheduling;
  between += other.between;
  return *this;
}

std::vector<Account> accounts_of(std::span<const RankLoad> ranks) {
  std::vector<Account> out;
  if (ranks.empty()) return out;
  const auto agreeing = [](const RankLoad& r) { return r.phase(Phase::agree); };
  const double least = agreeing(*std::ranges::min_element(ranks, {}, agreeing));
  for (const RankLoad& rank : ranks) out.push_back(account_of(rank, least));
  return out;
}

Account sum(std::span<const Account> accounts) {
  Account all;
  for (const Account& a : accounts) all += a;
  return all;
}

std::vector<RankLoad> loads_of(const Trace& trace) { return LoadsOfTrace(trace).read(); }

std::vector<RankLoad> gather_loads(const RankLoad& own, Transport& transport) {
  std::vector<RankLoad> all;
  for (const Bytes& bytes : transport.gather(0, pack(own))) all.push_back(unpack(bytes));
  return all;
}

}  // namespace moraine::runtime
