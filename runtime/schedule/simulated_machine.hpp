// SPDX-License-Identifier: Apache-2.0
// Runs a graph in simulated time: the same scheduling as the executor's, with durations given instead of work done.
#pragma once

#include <functional>
#include <vector>

#include "runtime/schedule/scheduler.hpp"

namespace moraine::runtime {

struct SimulatedTask {
  Task task;
  int worker = 0;
  double start = 0;
  double end = 0;
};

struct SimulatedRun {
  double elapsed = 0;
  std::vector<double> busy;          ///< per worker
  std::vector<SimulatedTask> tasks;  ///< in the order they end
  double utilisation() const;
};

/// `rounds` includes the opening one. Tasks that end at the same time do so in the order of their workers.
/// Errors: std::logic_error as Dispatcher. Cost: tasks times the logarithm of workers.
SimulatedRun simulate(Scheduler& scheduler, const StepGraph& graph, int workers, std::int64_t rounds,
                      const std::function<double(Task)>& duration);

}  // namespace moraine::runtime
