// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "runtime/profile/parts.hpp"

namespace moraine::runtime {
namespace {

struct EpochEnds {
  double start = 0;
  const TaskRecord* last = nullptr;
};

std::map<std::uint32_t, EpochEnds> ends_of(const Trace& trace) {
  std::map<std::uint32_t, EpochEnds> out;
  for (const TaskRecord& t : trace.lists.tasks) {
    EpochEnds& e = out.try_emplace(t.epoch, EpochEnds{t.start, &t}).first->second;
    e.start = std::min(e.start, t.start);
    if (t.end > e.last->end) e.last = &t;
  }
  for (const PhaseRecord& p : trace.lists.phases)
    if (const auto e = out.find(p.epoch); e != out.end() && p.phase == Phase::work)
      e->second.start = std::min(e->second.start, p.start);
  return out;
}

void count(const Segment& s, CriticalPath& path) {
  if (s.on == SpentOn::message) {
    path.messages += s.seconds();
    ++path.hops;
  } else if (s.on == SpentOn::scheduling) {
    path.scheduling += s.seconds();
  } else {
    path.tasks += s.seconds();
    path.stages.at(static_cast<std::size_t>(s.task->stage)) += s.seconds();
    path.ranks.at(static_cast<std::size_t>(s.task->rank)) += s.seconds();
  }
}

}  // namespace

CriticalPath critical_path(const Trace& trace, const Chains& chains, double elapsed) {
  CriticalPath path;
  path.stages.assign(trace.settings.stages.size(), 0.0);
  path.ranks.assign(static_cast<std::size_t>(trace.settings.ranks()), 0.0);
  for (const auto& [epoch, ends] : ends_of(trace)) {
    const std::vector<Segment> chain = chains.with(*ends.last, ends.start);
    for (const Segment& s : chain) count(s, path);
    path.segments.insert(path.segments.end(), chain.rbegin(), chain.rend());
  }
  path.between = std::max(0.0, elapsed - path.tasks - path.messages - path.scheduling);
  return path;
}

}  // namespace moraine::runtime
