// SPDX-License-Identifier: Apache-2.0
#include "runtime/schedule/simulated_machine.hpp"

#include <numeric>
#include <queue>
#include <tuple>

#include "runtime/schedule/dispatcher.hpp"

namespace moraine::runtime {
namespace {

struct EndsLater {
  bool operator()(const SimulatedTask& a, const SimulatedTask& b) const {
    return std::tie(a.end, a.worker) > std::tie(b.end, b.worker);
  }
};

}  // namespace

double SimulatedRun::utilisation() const {
  const double total = std::accumulate(busy.begin(), busy.end(), 0.0);
  return elapsed > 0 ? total / (static_cast<double>(busy.size()) * elapsed) : 1.0;
}

SimulatedRun simulate(Scheduler& scheduler, const StepGraph& graph, int workers, std::int64_t rounds,
                      const std::function<double(Task)>& duration) {
  SimulatedRun out;
  Dispatcher dispatcher(scheduler, graph, workers, rounds);
  out.busy.assign(static_cast<std::size_t>(workers), 0.0);
  std::priority_queue<SimulatedTask, std::vector<SimulatedTask>, EndsLater> running;
  std::vector<Assignment> starting;
  dispatcher.start(starting);
  while (true) {
    for (const Assignment& a : starting) running.push({a.task, a.worker, out.elapsed, out.elapsed + duration(a.task)});
    if (running.empty()) return out;
    const SimulatedTask ended = running.top();
    running.pop();
    out.elapsed = ended.end;
    out.busy[static_cast<std::size_t>(ended.worker)] += ended.end - ended.start;
    out.tasks.push_back(ended);
    starting.clear();
    dispatcher.finish(ended.task, ended.worker, starting);
  }
}

}  // namespace moraine::runtime
