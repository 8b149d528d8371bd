// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "runtime/profile/parts.hpp"

namespace moraine::runtime {
namespace {

class Waits {
 public:
  Waits(const Trace& trace, const Chains& chains, std::vector<SubModelProfile>& sub_models)
      : trace_(trace), chains_(chains), sub_models_(sub_models) {
    for (const TaskRecord& t : trace.lists.tasks) {
      const TaskRecord*& last = last_.try_emplace(t.epoch, &t).first->second;
      if (t.end > last->end) last = &t;
    }
  }

  std::vector<RankWait> all() {
    for (const PhaseRecord& p : trace_.lists.phases)
      if (p.phase == Phase::work)
        for (int w = 0; w < trace_.settings.threads.at(static_cast<std::size_t>(p.rank)); ++w)
          idle_[{p.epoch, p.rank, w}] = p.start;
    for (const TaskRecord& t : trace_.lists.tasks) {
      double& idle = idle_.try_emplace({t.epoch, t.rank, t.worker}, t.start).first->second;
      if (t.start > idle) blame(t.rank, chains_.before(t, idle));
      idle = t.end;
    }
    for (const auto& [key, idle] : idle_) {
      const auto& [epoch, rank, worker] = key;
      if (const auto last = last_.find(epoch); last != last_.end() && idle < last->second->end)
        blame(rank, chains_.with(*last->second, idle));
    }
    return sorted();
  }

 private:
  void blame(int waiter, const std::vector<Segment>& chain) {
    for (const Segment& s : chain) {
      if (s.on == SpentOn::scheduling) continue;
      RankWait& wait = pairs_[{waiter, s.task->rank}];
      (s.on == SpentOn::task ? wait.tasks : wait.messages) += s.seconds();
      if (s.on == SpentOn::task) sub_models_[s.task->sub_model].awaited += s.seconds();
    }
  }

  std::vector<RankWait> sorted() const {
    std::vector<RankWait> out;
    for (const auto& [ranks, wait] : pairs_) out.push_back({ranks.first, ranks.second, wait.tasks, wait.messages});
    std::ranges::stable_sort(out, std::greater<>(), [](const RankWait& w) { return w.tasks + w.messages; });
    return out;
  }

  const Trace& trace_;
  const Chains& chains_;
  std::vector<SubModelProfile>& sub_models_;
  std::map<std::uint32_t, const TaskRecord*> last_;             ///< task of an epoch
  std::map<std::tuple<std::uint32_t, int, int>, double> idle_;  ///< since when, by epoch, rank and worker
  std::map<std::pair<int, int>, RankWait> pairs_;
};

}  // namespace

std::vector<RankWait> who_waited(const Trace& trace, const Chains& chains, std::vector<SubModelProfile>& sub_models) {
  return Waits(trace, chains, sub_models).all();
}

}  // namespace moraine::runtime
