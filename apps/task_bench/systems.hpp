// SPDX-License-Identifier: Apache-2.0
// Who can run a problem: our schedulers, and others to compare with.
#pragma once

#include <string>

#include "problem.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::task_bench {

struct Outcome {
  double seconds = 0;          ///< from the first task to the last; building a graph ahead is not in it
  std::uint64_t checksum = 0;  ///< sum of the last values of points held here
};

/// One of our schedulers, through the contract of runtime/sub_model.hpp. Points are sub-models, shared out in blocks.
Outcome run_moraine(const Problem& problem, const std::string& scheduler, int threads, runtime::Transport& transport);
/// A oneTBB flow graph with a node per task, built before the clock starts.
Outcome run_flow_graph(const Problem& problem, int threads);
/// OpenMP tasks with depend clauses, made by one thread while the others run them.
Outcome run_openmp(const Problem& problem, int threads);

}  // namespace moraine::task_bench
