// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/workload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "runtime/trace/trace_file.hpp"

namespace moraine::runtime {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

double mean(std::vector<double> values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Finds the place of an epoch by its number in the trace.
class EpochIndex {
 public:
  EpochIndex(const Trace& trace, std::int64_t at_most) {
    std::vector<EpochRecord> records = trace.lists.epochs;
    std::ranges::sort(records, {}, &EpochRecord::epoch);
    for (const EpochRecord& r : records) {
      if (at_most >= 0 && static_cast<std::int64_t>(place_.size()) >= at_most) break;
      place_.emplace(r.epoch, place_.size());
      spans.push_back({r.first_round, r.rounds});
    }
  }
  std::optional<std::size_t> find(std::uint32_t epoch) const {
    const auto at = place_.find(epoch);
    return at == place_.end() ? std::nullopt : std::optional(at->second);
  }
  std::vector<Epoch> spans;

 private:
  std::map<std::uint32_t, std::size_t> place_;
};

/// What the ranks did in an epoch.
struct RankEpoch {
  Between between;
  double work_begin = 0, work_end = 0, first_task = 0, last_task = 0;
  bool any_task = false;
  double begin = 0, end = 0;  ///< of all phases
  bool any_phase = false;
};

class Reader {
 public:
  Reader(const Trace& trace, std::int64_t epochs) : trace_(trace), index_(trace, epochs) {
    out_.settings = trace.settings;
    out_.sub_models = static_cast<std::size_t>(trace.settings.sub_models);
    for (const Epoch& span : index_.spans) out_.epochs.push_back(empty_epoch(span));
    ranks_.resize(out_.epochs.size());
  }

  Workload read() {
    read_tasks();
    read_models();
    read_phases();
    drop_incomplete();
    if (out_.shares_cores()) slow_down(1 + share_of_watching());
    for (const WorkEpoch& e : out_.epochs) out_.traced_makespan += e.traced_seconds;
    if (out_.epochs.empty()) throw TraceError("the trace holds no complete epoch, expected one at least");
    measure_overheads();
    return std::move(out_);
  }

 private:
  WorkEpoch empty_epoch(const Epoch& span) const {
    WorkEpoch e;
    e.span = span;
    e.cost.assign(out_.nodes(), 0.0);
    e.memory.assign(out_.sub_models, 0.0);
    e.seconds.assign(out_.nodes() * static_cast<std::size_t>(span.rounds_with_opening()), -1.0);
    e.owner.assign(out_.sub_models, 0);
    return e;
  }

  std::size_t node(std::uint32_t sub_model, int stage) const {
    if (sub_model >= out_.sub_models || stage < 0 || static_cast<std::size_t>(stage) >= out_.stages())
      throw TraceError(fmt::format("the trace names stage {} of sub-model {}, of {} and {}", stage, sub_model,
                                   out_.stages(), out_.sub_models));
    return sub_model * out_.stages() + static_cast<std::size_t>(stage);
  }

  WorkEpoch* epoch(std::uint32_t number) {
    const auto at = index_.find(number);
    return at ? &out_.epochs[*at] : nullptr;
  }

  RankEpoch& rank_epoch(std::uint32_t number, int rank) { return ranks_[*index_.find(number)][rank]; }

  void read_tasks() {
    for (const TaskRecord& t : trace_.lists.tasks) {
      WorkEpoch* e = epoch(t.epoch);
      if (e == nullptr) continue;
      const std::size_t at = static_cast<std::size_t>(t.in_epoch) * out_.nodes() + node(t.sub_model, t.stage);
      if (t.in_epoch < 0 || at >= e->seconds.size()) throw TraceError("the trace has a task outside its epoch");
      e->seconds[at] = out_.shares_cores() ? static_cast<double>(t.processor) : t.seconds();
      RankEpoch& r = rank_epoch(t.epoch, t.rank);
      r.first_task = r.any_task ? std::min(r.first_task, t.start) : t.start;
      r.last_task = r.any_task ? std::max(r.last_task, t.end) : t.end;
      r.any_task = true;
    }
  }

  /// Of the time that workers 0 have cores for while tasks run, what does not go into their tasks, by what does: mostly
  /// looking for messages. It is taken from those who share the cores.
  double share_of_watching() const {
    double all = 0, tasks = 0;
    for (const PhaseRecord& p : trace_.lists.phases) all += p.phase == Phase::work ? p.processor : 0;
    for (const TaskRecord& t : trace_.lists.tasks) tasks += t.worker == 0 ? t.processor : 0;
    return tasks > 0 ? std::max(0.0, all / tasks - 1) : 0;
  }

  void slow_down(double factor) {
    for (WorkEpoch& e : out_.epochs)
      for (double& seconds : e.seconds) seconds *= factor;
  }

  void read_models() {
    for (const OwnerRecord& o : trace_.lists.owners)
      if (WorkEpoch* e = epoch(o.epoch)) {
        node(o.sub_model, 0);
        e->owner[o.sub_model] = o.rank;
        e->memory[o.sub_model] = o.memory;
      }
    for (const CostRecord& c : trace_.lists.costs)
      if (WorkEpoch* e = epoch(c.epoch)) e->cost[node(c.sub_model, c.stage)] = c.cost;
    for (const MessageRecord& m : trace_.lists.messages)
      if (WorkEpoch* e = epoch(m.epoch)) {
        node(m.from, m.sent_in);
        node(m.to, m.read_in);
        e->messages.push_back({{m.from, m.sent_in, m.to, m.read_in},
                               m.messages > 0 ? static_cast<double>(m.bytes) / static_cast<double>(m.messages) : 0.0});
      }
    for (WorkEpoch& e : out_.epochs) std::ranges::sort(e.messages, {}, &SizedMessage::message);
    for (const BalanceRoundRecord& b : trace_.lists.balance)
      if (WorkEpoch* e = epoch(b.epoch); e != nullptr && b.carried_out != 0) e->moving += b.cost_seconds;
  }

  void read_phases() {
    for (const PhaseRecord& p : trace_.lists.phases) {
      if (!index_.find(p.epoch)) continue;
      RankEpoch& r = rank_epoch(p.epoch, p.rank);
      if (p.phase == Phase::work)
        r.work_begin = p.start, r.work_end = p.end;
      else
        r.between.phase.at(static_cast<std::size_t>(p.phase)) += p.seconds();
      r.begin = r.any_phase ? std::min(r.begin, p.start) : p.start;
      r.end = r.any_phase ? std::max(r.end, p.end) : p.end;
      r.any_phase = true;
    }
    for (std::size_t i = 0; i < out_.epochs.size(); ++i) {
      out_.epochs[i].between = slowest(ranks_[i]);
      out_.epochs[i].traced_seconds = elapsed(ranks_[i]);
    }
  }

  static double elapsed(const std::map<int, RankEpoch>& ranks) {
    if (ranks.empty()) return 0;
    double begin = ranks.begin()->second.begin, end = ranks.begin()->second.end;
    for (const auto& [rank, r] : ranks) begin = std::min(begin, r.begin), end = std::max(end, r.end);
    return end - begin;
  }

  /// The rank whose tasks ended last waited for nobody; in its phases there is work alone.
  static Between slowest(const std::map<int, RankEpoch>& ranks) {
    const RankEpoch* last = nullptr;
    for (const auto& [rank, r] : ranks)
      if (last == nullptr || r.work_end > last->work_end) last = &r;
    if (last == nullptr) return {};
    Between between = last->between;
    const double tasks = last->any_task ? last->last_task - last->first_task : 0.0;
    between.phase[static_cast<std::size_t>(Phase::work)] = std::max(0.0, last->work_end - last->work_begin - tasks);
    return between;
  }

  void drop_incomplete() {
    std::erase_if(out_.epochs,
                  [](const WorkEpoch& e) { return std::ranges::any_of(e.seconds, [](double s) { return s < 0; }); });
  }

  void measure_overheads() {
    std::map<std::pair<int, int>, const TaskRecord*> last;
    std::vector<const TaskRecord*> tasks;
    for (const TaskRecord& t : trace_.lists.tasks) tasks.push_back(&t);
    std::ranges::sort(tasks, {}, &TaskRecord::start);
    std::vector<double> next, wake, message, unnoticed;
    for (const TaskRecord* t : tasks) {
      const TaskRecord*& before = last[{t->rank, t->worker}];
      if (before != nullptr && before->epoch == t->epoch)
        (t->handed <= before->end ? next : wake).push_back(t->start - t->handed);
      if (t->release == Release::message) {
        const bool waited = before == nullptr || before->epoch != t->epoch || before->end <= t->sent;
        (waited ? message : unnoticed).push_back(t->ready - t->sent);
      }
      before = t;
    }
    // Where cores are shared, means tell of waiting for a core, which a replay finds out itself.
    const auto typical = out_.shares_cores() ? median : mean;
    // Clocks of ranks agree to some microseconds only, so a message may seem to arrive before it was sent.
    out_.overheads = {std::max(0.0, typical(next)), std::max(0.0, typical(wake)),
                      std::max(0.0, typical(message.empty() ? unnoticed : message))};
  }

  const Trace& trace_;
  EpochIndex index_;
  Workload out_;
  std::vector<std::map<int, RankEpoch>> ranks_;  ///< per epoch, by rank
};

}  // namespace

bool Workload::shares_cores() const {
  const double cores = settings.all_cores();
  return cores > 0 && settings.workers() > cores + 0.5;
}

double Workload::seconds() const {
  double sum = 0;
  for (const WorkEpoch& e : epochs) sum += std::accumulate(e.seconds.begin(), e.seconds.end(), 0.0);
  return sum;
}

Workload workload_of(const Trace& trace, std::int64_t epochs) { return Reader(trace, epochs).read(); }

}  // namespace moraine::runtime
