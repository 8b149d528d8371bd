// SPDX-License-Identifier: Apache-2.0
// A traced run on another machine, without running it.
#pragma once

#include "runtime/replay/cluster.hpp"

namespace moraine::runtime {

struct ReplayOptions {
  Machine machine;
  std::string balancer = "refine";   ///< a name of balancers()
  std::string predictor = "median";  ///< a name of predictors()
  std::int64_t balance_every = 1;    ///< rounds
  bool balance_measured = false;
  std::size_t copies = 1;        ///< of the model, side by side
  bool initial_by_cost = false;  ///< first owners know the first epoch's predicted loads; runs take them as equal
};

/// Ranks, threads, scheduler, balancer and overheads of the traced run, a core for each thread. A message takes 2 us if
/// none was sent between ranks.
ReplayOptions as_traced(const Workload& work);

/// Seconds of simulated time.
struct Prediction {
  double makespan = 0;
  double work = 0;                 ///< of all tasks
  double tasks_span = 0;           ///< of the makespan: in which tasks run
  double between = 0;              ///< of the makespan: between epochs, but for balancing
  double balancing = 0;            ///< of the makespan
  double utilisation = 1;          ///< work / (makespan * what can work at once)
  double tasks_utilisation = 1;    ///< the same of tasks_span
  double imbalance = 1;            ///< busiest rank / mean rank, mean over epochs by time
  double messages = 0, bytes = 0;  ///< between ranks
  std::int64_t tasks = 0, migrations = 0, balance_rounds = 0;
  double moved_bytes = 0;
  double planning = 0;  ///< what the balancer itself took on this machine; not in the makespan
};

/// The traced epochs with other ranks, threads, scheduler, balancer and network. Between epochs all ranks meet. What
/// they do there: with the traced number of ranks and one copy, as long as it took; else settling neighbours, planning
/// and checkpoints as long as it took per sub-model held, on the rank that holds most; output as long as it took, times
/// copies; agreeing 2 * ceil(log2 ranks) latencies. Balancing: if ranks, copies and balancer are those of the trace, as
/// it took; else collecting (as it took with the traced ranks, less what moves were forecast to take; else as agreeing)
/// and the forecast cost of moves. The balancer sees what it sees in a run.
/// Errors: std::invalid_argument for unknown names or numbers that make no sense.
Prediction replay(const Workload& work, const ReplayOptions& options);

}  // namespace moraine::runtime
