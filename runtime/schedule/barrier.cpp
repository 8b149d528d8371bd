// SPDX-License-Identifier: Apache-2.0
// Stage by stage: all sub-models finish a stage before any starts the next. Each worker has a fixed block of
// sub-models. What a bulk-synchronous code does, to compare with.
#include "runtime/schedule/oldest_first.hpp"
#include "runtime/schedule/policies.hpp"

namespace moraine::runtime {
namespace {

class Barrier final : public Scheduler {
 public:
  void begin(const StepGraph& graph, int workers, std::int64_t) override {
    graph_ = &graph;
    position_ = 0;
    unfinished_ = graph.sub_models;
    queues_.assign(static_cast<std::size_t>(workers), {});
  }

  void ready(Task task, int) override {
    const std::size_t owner = graph_->place(task.node) * queues_.size() / graph_->sub_models;
    queues_[owner].push(*graph_, task);
  }

  void finished(Task, int) override {
    if (--unfinished_ > 0) return;
    unfinished_ = graph_->sub_models;
    ++position_;
  }

  std::optional<Task> next(int worker) override {
    OldestFirst& queue = queues_[static_cast<std::size_t>(worker)];
    if (queue.empty() || queue.top_position() > position_) return std::nullopt;
    return queue.pop();
  }

 private:
  const StepGraph* graph_ = nullptr;
  std::int64_t position_ = 0;   ///< the stage that may run, counted over all rounds
  std::size_t unfinished_ = 0;  ///< its tasks that are not done
  std::vector<OldestFirst> queues_;
};

}  // namespace

std::unique_ptr<Scheduler> make_barrier() { return std::make_unique<Barrier>(); }

}  // namespace moraine::runtime
