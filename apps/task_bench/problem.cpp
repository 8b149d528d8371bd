// SPDX-License-Identifier: Apache-2.0
#include "problem.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <random>
#include <stdexcept>
#include <thread>

namespace moraine::task_bench {
namespace {

using Sources = std::vector<std::vector<Point>>;

Sources trivial(std::size_t width) { return Sources(width); }

Sources stencil(std::size_t width) {
  Sources sources(width);
  for (Point p = 0; p < width; ++p) {
    if (p > 0) sources[p].push_back(p - 1);
    if (p + 1 < width) sources[p].push_back(p + 1);
  }
  return sources;
}

Sources tree(std::size_t width) {
  Sources sources(width);
  for (Point p = 1; p < width; ++p) sources[p].push_back((p - 1) / 2);
  return sources;
}

/// Three others each, or all if there are fewer.
Sources random_neighbours(std::size_t width) {
  Sources sources(width);
  std::mt19937 random(7);
  for (Point p = 0; p < width; ++p) {
    while (sources[p].size() < std::min<std::size_t>(3, width - 1)) {
      const auto other = static_cast<Point>(random() % width);
      if (other == p || std::ranges::count(sources[p], other) > 0) continue;
      sources[p].push_back(other);
    }
    std::ranges::sort(sources[p]);
  }
  return sources;
}

const std::array table{
    Pattern{"trivial", "points know nothing of each other", trivial},
    Pattern{"stencil", "left and right neighbour", stencil},
    Pattern{"tree", "the parent in a binary tree", tree},
    Pattern{"random", "three others, drawn once", random_neighbours},
};

std::uint64_t drawn(Point point, std::int64_t step) {
  std::uint64_t x = (static_cast<std::uint64_t>(step) << 32 | point) + 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;  // splitmix64
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Of this thread: others that share its core do not count.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double time_iteration() {
  constexpr std::int64_t iterations = 2'000'000;
  std::vector<double> times;
  volatile std::uint64_t result = 1;
  for (int i = 0; i < 9; ++i) {
    const double begin = processor_seconds();
    result = spin(result, iterations);
    times.push_back((processor_seconds() - begin) / iterations);
  }
  std::ranges::nth_element(times, times.begin() + 4);
  return times[4];
}

}  // namespace

std::span<const Pattern> patterns() { return table; }

TaskGraph make_graph(const std::string& pattern, std::size_t width) {
  const auto row = std::ranges::find(table, pattern, &Pattern::name);
  if (row == table.end()) throw std::invalid_argument("no pattern is called '" + pattern + "'");
  TaskGraph graph{row->sources(width), Sources(width)};
  for (Point p = 0; p < width; ++p)
    for (const Point source : graph.sources[p]) graph.targets[source].push_back(p);
  return graph;
}

Kernel find_kernel(const std::string& name) {
  if (name == "empty") return Kernel::empty;
  if (name == "fixed") return Kernel::fixed;
  if (name == "imbalanced") return Kernel::imbalanced;
  throw std::invalid_argument("no kernel is called '" + name + "', expected empty, fixed or imbalanced");
}

std::int64_t Problem::iterations_of(Point point, std::int64_t step) const {
  if (kernel == Kernel::empty) return 0;
  if (kernel == Kernel::fixed) return iterations;
  return static_cast<std::int64_t>(drawn(point, step) % static_cast<std::uint64_t>(2 * iterations + 1));
}

std::int64_t Problem::total_iterations() const {
  std::int64_t sum = 0;
  for (std::int64_t step = 0; step < steps; ++step)
    for (Point p = 0; p < graph.width(); ++p) sum += iterations_of(p, step);
  return sum;
}

std::uint64_t spin(std::uint64_t value, std::int64_t iterations) {
  for (std::int64_t i = 0; i < iterations; ++i) value = value * 6364136223846793005ULL + 1442695040888963407ULL;
  return value ^ (value >> 29);
}

Task::Task(const Problem& problem, Point point, std::int64_t step, std::uint64_t own)
    : iterations_(problem.iterations_of(point, step)), value_(own) {}

double seconds_per_iteration(int threads) {
  std::vector<double> times(static_cast<std::size_t>(threads));
  std::vector<std::thread> workers;
  for (double& time : times) workers.emplace_back([&time] { time = time_iteration(); });
  for (std::thread& worker : workers) worker.join();
  return *std::ranges::min_element(times);
}

}  // namespace moraine::task_bench
