// SPDX-License-Identifier: Apache-2.0
// One epoch on many ranks in simulated time: every rank has the scheduler and dispatcher that a real one has; tasks
// take as long as they were measured to, messages as long as a simple network makes them.
#pragma once

#include <string>
#include <vector>

#include "runtime/replay/recorded_model.hpp"

namespace moraine::runtime {

struct Machine {
  int ranks = 1;
  int threads = 1;  ///< of each rank
  int cores = 0;    ///< that all of them share: a task waits for one, first come first served; 0: one for each thread
  std::string scheduler = "hybrid";
  double latency = 2e-6;    ///< seconds per message between ranks
  double bandwidth = 1e10;  ///< bytes/s that a rank can send; its messages queue
  double speed = 1;         ///< of cores, relative to the traced ones
  Overheads overheads;

  double workers() const { return static_cast<double>(ranks) * threads; }
  /// What can work at once.
  double capacity() const { return cores > 0 ? std::min(workers(), static_cast<double>(cores)) : workers(); }
};

struct ClusterRun {
  double elapsed = 0;           ///< seconds to the end of the last rank's last task
  std::vector<double> busy;     ///< per rank, seconds of work
  std::vector<double> seconds;  ///< per sub-model
  std::int64_t tasks = 0;
  double messages = 0, bytes = 0;  ///< between ranks
};

/// `model` has been shared out. `rounds` includes the opening one. A message is delivered when its slot at the reader
/// is free, as in Mail. Tasks that end at the same time do so in the order of ranks and workers. Errors: as Dispatcher
/// and build_step_graph(). Cost: O((tasks + messages) log workers), about a microsecond per task.
ClusterRun simulate(RecordedModel& model, const Machine& machine, std::int64_t rounds);

}  // namespace moraine::runtime
