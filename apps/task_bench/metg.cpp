// SPDX-License-Identifier: Apache-2.0
#include "metg.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::task_bench {
namespace {

constexpr double largest_task = 1e-4, least_efficiency = 0.25;  // seconds; share
constexpr std::int64_t fewest_steps = 20, most_steps = 500;

std::int64_t steps_for(const Measurement& m, double task_seconds) {
  const double steps = m.run_seconds * m.cores / (task_seconds * static_cast<double>(m.problem.graph.width()));
  return std::clamp(static_cast<std::int64_t>(steps), fewest_steps, most_steps);
}

Outcome median_run(const Measurement& m, const Problem& problem) {
  std::vector<Outcome> outcomes;
  for (int i = 0; i < m.repeats; ++i) outcomes.push_back(m.run(problem));
  const auto middle = outcomes.begin() + m.repeats / 2;
  std::ranges::nth_element(outcomes, middle, {}, &Outcome::seconds);
  return *middle;
}

}  // namespace

Sweep sweep(const Measurement& m) {
  Sweep out;
  int low = 0;  // sizes in a row; one alone may be a disturbance
  for (auto n = static_cast<std::int64_t>(largest_task / m.seconds_per_iteration); n > 0; n /= 2) {
    if (low == 2) break;
    Problem problem = m.problem;
    problem.iterations = n;
    problem.steps = steps_for(m, static_cast<double>(n) * m.seconds_per_iteration);
    const Outcome o = median_run(m, problem);
    const double offered = o.seconds * m.cores;
    const double efficiency = static_cast<double>(problem.total_iterations()) * m.seconds_per_iteration / offered;
    low = efficiency < least_efficiency ? low + 1 : 0;
    out.push_back({n, offered / static_cast<double>(problem.tasks()), efficiency, o.checksum});
  }
  return out;
}

std::optional<double> metg(const Sweep& sweep) {
  for (std::size_t i = sweep.size(); i-- > 1;) {
    const Size &above = sweep[i - 1], &below = sweep[i];
    if (above.efficiency < 0.5 || below.efficiency >= 0.5) continue;
    const double share = (above.efficiency - 0.5) / (above.efficiency - below.efficiency);
    return std::exp((1 - share) * std::log(above.task_seconds) + share * std::log(below.task_seconds));
  }
  return std::nullopt;
}

double overhead(const Measurement& m) {
  Problem problem = m.problem;
  problem.kernel = Kernel::empty;
  problem.steps = most_steps;
  return median_run(m, problem).seconds * m.cores / static_cast<double>(problem.tasks());
}

}  // namespace moraine::task_bench
