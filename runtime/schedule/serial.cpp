// SPDX-License-Identifier: Apache-2.0
// One worker does everything, what is furthest behind first: the order of a plain loop.
#include "runtime/schedule/oldest_first.hpp"
#include "runtime/schedule/policies.hpp"

namespace moraine::runtime {
namespace {

class Serial final : public Scheduler {
 public:
  void begin(const StepGraph& graph, int, std::int64_t) override {
    graph_ = &graph;
    queue_ = {};
  }
  void ready(Task task, int) override { queue_.push(*graph_, task); }
  std::optional<Task> next(int worker) override {
    if (worker != 0 || queue_.empty()) return std::nullopt;
    return queue_.pop();
  }

 private:
  const StepGraph* graph_ = nullptr;
  OldestFirst queue_;
};

}  // namespace

std::unique_ptr<Scheduler> make_serial() { return std::make_unique<Serial>(); }

}  // namespace moraine::runtime
