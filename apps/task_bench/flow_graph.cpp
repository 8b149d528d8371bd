// SPDX-License-Identifier: Apache-2.0
#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/task_arena.h>

#include <chrono>
#include <deque>
#include <numeric>

#include "systems.hpp"

namespace moraine::task_bench {
namespace {

namespace flow = tbb::flow;
using Node = flow::continue_node<flow::continue_msg>;
using Clock = std::chrono::steady_clock;

/// Every task has a value of its own, so nothing but what the pattern says orders tasks.
class Unrolled {
 public:
  explicit Unrolled(const Problem& problem)
      : problem_(problem),
        width_(problem.graph.width()),
        values_(width_ * static_cast<std::size_t>(problem.steps + 1)) {
    for (Point p = 0; p < width_; ++p) values_[p] = first_value(p);
    for (std::int64_t step = 0; step < problem.steps; ++step)
      for (Point p = 0; p < width_; ++p) add(step, p);
  }

  Outcome run() {
    const auto begin = Clock::now();
    start_.try_put({});
    graph_.wait_for_all();
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return {seconds,
            std::accumulate(values_.end() - static_cast<std::ptrdiff_t>(width_), values_.end(), std::uint64_t{})};
  }

 private:
  std::uint64_t& value(std::int64_t step, Point p) { return values_[static_cast<std::size_t>(step) * width_ + p]; }

  void add(std::int64_t step, Point p) {
    Node& node = nodes_.emplace_back(graph_, [this, step, p](const flow::continue_msg& m) {
      advance(step, p);
      return m;
    });
    if (step == 0) return flow::make_edge(start_, node);
    const std::size_t before = static_cast<std::size_t>(step - 1) * width_;
    flow::make_edge(nodes_[before + p], node);
    for (const Point source : problem_.graph.sources[p]) flow::make_edge(nodes_[before + source], node);
  }

  void advance(std::int64_t step, Point p) {
    Task task(problem_, p, step, value(step, p));
    for (const Point source : problem_.graph.sources[p]) task.take(value(step, source));
    value(step + 1, p) = task.run();
  }

  const Problem& problem_;
  std::size_t width_;
  std::vector<std::uint64_t> values_;
  flow::graph graph_;
  flow::broadcast_node<flow::continue_msg> start_{graph_};
  std::deque<Node> nodes_;
};

}  // namespace

Outcome run_flow_graph(const Problem& problem, int threads) {
  tbb::task_arena arena(threads);
  return arena.execute([&] { return Unrolled(problem).run(); });
}

}  // namespace moraine::task_bench
