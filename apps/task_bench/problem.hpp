// SPDX-License-Identifier: Apache-2.0
// Task graphs and kernels in the manner of Task Bench (Slaughter et al. 2020, "Task Bench: a parameterized benchmark
// for evaluating parallel runtime performance", SC20).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace moraine::task_bench {

using Point = std::uint32_t;

/// Points by steps. A task waits for its own point and for `sources` of it, all of the step before.
struct TaskGraph {
  std::vector<std::vector<Point>> sources;  ///< per point, ascending, without itself
  std::vector<std::vector<Point>> targets;  ///< the same, the other way round
  std::size_t width() const { return sources.size(); }
};

struct Pattern {
  std::string name;
  std::string help;
  std::vector<std::vector<Point>> (*sources)(std::size_t width);
};

std::span<const Pattern> patterns();
/// Errors: std::invalid_argument for an unknown name.
TaskGraph make_graph(const std::string& pattern, std::size_t width);

enum class Kernel { empty, fixed, imbalanced };
Kernel find_kernel(const std::string& name);

/// A graph to be run. What it computes depends on nothing else, so all systems must end with the same checksum.
struct Problem {
  TaskGraph graph;
  Kernel kernel = Kernel::fixed;
  std::int64_t steps = 0;
  std::int64_t iterations = 0;  ///< of the kernel's loop, mean over tasks

  std::int64_t tasks() const { return steps * static_cast<std::int64_t>(graph.width()); }
  /// Of one task. Imbalanced: uniform in 0 .. 2 * iterations, drawn from point and step.
  std::int64_t iterations_of(Point point, std::int64_t step) const;
  /// Of all tasks.
  std::int64_t total_iterations() const;
};

inline std::uint64_t first_value(Point point) { return point + 1; }

/// A chain of multiplications, which keeps a core busy in proportion to `iterations` and cannot be optimised away.
std::uint64_t spin(std::uint64_t value, std::int64_t iterations);

/// The task of (point, step): takes the values of its point and its sources, in that order.
class Task {
 public:
  Task(const Problem& problem, Point point, std::int64_t step, std::uint64_t own);
  void take(std::uint64_t value) { value_ = value_ * 31 + value; }
  std::uint64_t run() const { return spin(value_, iterations_); }

 private:
  std::int64_t iterations_;
  std::uint64_t value_;
};

/// Seconds of processor time per iteration while `threads` threads work, the median of several.
double seconds_per_iteration(int threads);

}  // namespace moraine::task_bench
