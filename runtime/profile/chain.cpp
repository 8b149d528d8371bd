// SPDX-License-Identifier: Apache-2.0
#include "runtime/profile/chain.hpp"

#include <stdexcept>

namespace moraine::runtime {
namespace {

constexpr double rounding = 2e-9;  // of times in JSON traces

}  // namespace

Chains::Chains(const Trace& trace)
    : index_(trace.lists.tasks), by_end_(static_cast<std::size_t>(trace.settings.ranks())) {
  for (const TaskRecord& t : trace.lists.tasks) {
    if (t.rank < 0 || t.rank >= trace.settings.ranks())
      throw std::invalid_argument("the trace has a task of a rank that it does not know");
    by_end_[static_cast<std::size_t>(t.rank)].push_back(&t);
  }
  for (auto& list : by_end_) std::ranges::stable_sort(list, {}, &TaskRecord::end);
}

std::vector<Segment> Chains::before(const TaskRecord& task, double until) const {
  std::vector<Segment> out;
  follow(task, until, out);
  return out;
}

std::vector<Segment> Chains::with(const TaskRecord& task, double until) const {
  std::vector<Segment> out;
  const double from = std::max(task.start, until);
  if (task.end > from) out.push_back({from, task.end, SpentOn::task, &task});
  follow(task, until, out);
  return out;
}

void Chains::follow(const TaskRecord& task, double until, std::vector<Segment>& out) const {
  double now = task.start;
  const auto back_to = [&](double time, SpentOn on, const TaskRecord* of) {
    const double from = std::clamp(time, std::min(until, now), now);
    if (from < now) out.push_back({from, now, on, of});
    now = from;
  };
  const TaskRecord* current = &task;
  for (std::size_t links = index_.size(); links > 0 && now > until; --links) {
    const TaskRecord* by = awaited(*current);
    if (by == nullptr) break;
    if (by->rank != current->rank) {
      back_to(current->ready, SpentOn::scheduling, current);
      back_to(by->end, SpentOn::message, by);
    }
    back_to(by->end, SpentOn::scheduling, current);
    back_to(by->start, SpentOn::task, by);
    current = by;
  }
  back_to(until, SpentOn::scheduling, current);
}

const TaskRecord* Chains::awaited(const TaskRecord& task) const {
  return task.handed > task.ready + rounding ? ended_by(task) : index_.releasing(task);
}

/// The last of its rank that ended before it was handed out.
const TaskRecord* Chains::ended_by(const TaskRecord& task) const {
  const auto& list = by_end_[static_cast<std::size_t>(task.rank)];
  const auto after = std::ranges::upper_bound(list, task.handed + rounding, {}, &TaskRecord::end);
  if (after == list.begin()) return nullptr;
  const TaskRecord* last = *(after - 1);
  return last->epoch == task.epoch && last != &task ? last : nullptr;
}

}  // namespace moraine::runtime
