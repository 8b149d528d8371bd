// SPDX-License-Identifier: Apache-2.0
#include <omp.h>

#include <array>
#include <numeric>

#include "systems.hpp"

namespace moraine::task_bench {
namespace {

using Values = std::vector<std::uint64_t>;

void advance(const Problem& problem, std::int64_t step, Point p, const Values& before, Values& after) {
  Task task(problem, p, step, before[p]);
  for (const Point source : problem.graph.sources[p]) task.take(before[source]);
  after[p] = task.run();
}

/// Two values per point, used by turns; the depend clauses also keep a value until all have read it.
void make_tasks(const Problem& problem, std::array<Values, 2>& values) {
  for (std::int64_t step = 0; step < problem.steps; ++step)
    for (Point p = 0; p < problem.graph.width(); ++p) {
      // GCC 12 does not see that depend clauses use them.
      [[maybe_unused]] const std::uint64_t* before = values[step & 1].data();
      [[maybe_unused]] std::uint64_t* after = values[(step + 1) & 1].data();
      [[maybe_unused]] const Point* source = problem.graph.sources[p].data();
      [[maybe_unused]] const auto count = static_cast<int>(problem.graph.sources[p].size());
#pragma omp task default(none) firstprivate(step, p) shared(problem, values) depend(iterator(i = 0       \
                                                                                             : count),   \
                                                                                    in                   \
                                                                                    : before[source[i]]) \
    depend(in                                                                                            \
           : before[p]) depend(out                                                                       \
                               : after[p])
      advance(problem, step, p, values[step & 1], values[(step + 1) & 1]);
    }
}

}  // namespace

Outcome run_openmp(const Problem& problem, int threads) {
  std::array<Values, 2> values;
  for (Values& v : values) v.resize(problem.graph.width());
  for (Point p = 0; p < problem.graph.width(); ++p) values[0][p] = first_value(p);
#pragma omp parallel num_threads(threads)
  {}
  const double begin = omp_get_wtime();
#pragma omp parallel num_threads(threads)
#pragma omp single
  make_tasks(problem, values);
  const double seconds = omp_get_wtime() - begin;
  const Values& last = values[problem.steps & 1];
  return {seconds, std::accumulate(last.begin(), last.end(), std::uint64_t{})};
}

}  // namespace moraine::task_bench
