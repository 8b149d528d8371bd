// SPDX-License-Identifier: Apache-2.0
// How busy workers were, and with what.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/step_graph.hpp"
#include "runtime/trace/wait.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// What a task took.
struct Taken {
  double seconds = 0;    ///< from start to end
  double processor = 0;  ///< of these, with a core; the same as seconds where it is not measured
};

/// What tasks took, and how many they were.
struct Busy {
  Taken taken;
  std::int64_t tasks = 0;
  void add(const Taken& more, std::int64_t count = 1) {
    taken.seconds += more.seconds;
    taken.processor += more.processor;
    tasks += count;
  }
};

/// Work of one or several epochs. A worker that is not busy waits.
struct LoadRecord {
  double elapsed = 0;  ///< seconds
  std::vector<Busy> workers;
  std::vector<Wait> waits;  ///< per worker
  std::vector<Busy> stages;
  std::vector<Busy> nodes;  ///< by sub-model number * stages + stage, of those that ran here

  LoadRecord() = default;
  LoadRecord(const StepGraph& graph, int workers);
  void add(const StepGraph& graph, Task task, int worker, const Taken& taken);
  /// Adds another epoch's. Lists grow to the longer one.
  void merge(const LoadRecord& other);

  double busy() const;  ///< seconds, all workers
  std::int64_t tasks() const;
  double utilisation() const;       ///< busy / (workers * elapsed); 1 if nothing ran
  double waiting_fraction() const;  ///< 1 - utilisation
  double imbalance() const;         ///< busiest worker / mean worker, in processor time; 1 if nothing ran
  /// Processor time of a sub-model's tasks here [s].
  double processor_of(SubModelId id) const;
  /// Mean seconds of the tasks of each of the graph's nodes; 0 for those that did not run here.
  std::vector<double> mean_cost(const StepGraph& graph) const;
};

/// Of all ranks: their workers one after another, the sum of their stages and nodes, the longest elapsed time.
/// Collective.
LoadRecord all_ranks(const LoadRecord& own, Transport& transport);

}  // namespace moraine::runtime
