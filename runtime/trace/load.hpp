// SPDX-License-Identifier: Apache-2.0
// How busy workers were, and with what.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/step_graph.hpp"

namespace moraine::runtime {

/// Time and number of tasks.
struct Busy {
  double seconds = 0;
  std::int64_t tasks = 0;
  void add(double more) {
    seconds += more;
    ++tasks;
  }
};

/// One or several epochs. A worker that is not busy waits: for a task, or for the scheduler.
struct LoadRecord {
  double elapsed = 0;  ///< seconds
  std::vector<Busy> workers;
  std::vector<Busy> stages;
  std::vector<Busy> nodes;  ///< as in the step graph

  LoadRecord() = default;
  LoadRecord(const StepGraph& graph, int workers);
  void add(const StepGraph& graph, Task task, int worker, double seconds);
  /// Adds another epoch's. Lists grow to the longer one.
  void merge(const LoadRecord& other);

  double busy() const;  ///< seconds, all workers
  std::int64_t tasks() const;
  double utilisation() const;       ///< busy / (workers * elapsed); 1 if nothing ran
  double waiting_fraction() const;  ///< 1 - utilisation
  double imbalance() const;         ///< busiest worker / mean worker; 1 if nothing ran
  /// Mean seconds of each node's tasks, to predict the next epoch's cost with.
  std::vector<double> mean_cost() const;
};

}  // namespace moraine::runtime
