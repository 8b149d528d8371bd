// SPDX-License-Identifier: Apache-2.0
// The smallest task that still pays.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "problem.hpp"
#include "systems.hpp"

namespace moraine::task_bench {

/// One size of task.
struct Size {
  std::int64_t iterations = 0;
  double task_seconds = 0;  ///< time of a core per task: elapsed * cores / tasks
  double efficiency = 0;    ///< seconds of useful work / (elapsed * cores)
  std::uint64_t checksum = 0;
};

using Sweep = std::vector<Size>;  ///< large tasks first

/// What is measured, and on how many cores.
struct Measurement {
  Problem problem;  ///< steps and iterations are chosen
  double seconds_per_iteration = 0;
  int cores = 1;
  int repeats = 5;
  double run_seconds = 0.01;  ///< of useful work in one run, about
  /// Collective, if there are several ranks: the longest time of all, and the sum of checksums.
  std::function<Outcome(const Problem&)> run;
};

/// Halves tasks until less than a quarter of the time is useful. Each size: the median of `repeats` runs.
Sweep sweep(const Measurement& m);

/// METG(50 %): the least time of a core per task at which the efficiency is one half, between two sizes by the
/// logarithms; none if it never is that high or low.
std::optional<double> metg(const Sweep& sweep);

/// Time of a core per empty task.
double overhead(const Measurement& m);

}  // namespace moraine::task_bench
