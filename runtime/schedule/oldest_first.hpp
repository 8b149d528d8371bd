// SPDX-License-Identifier: Apache-2.0
// Ready tasks, those that are furthest behind first.
#pragma once

#include <queue>
#include <vector>

#include "runtime/step_graph.hpp"

namespace moraine::runtime {

/// How far a task is: stages since the start of the epoch.
inline std::int64_t stage_position(const StepGraph& graph, Task task) {
  return task.round * static_cast<std::int64_t>(graph.stages.size()) + graph.stage(task.node);
}

/// A queue by (round, stage, sub-model). Cost: logarithmic.
class OldestFirst {
 public:
  bool empty() const { return heap_.empty(); }
  std::size_t size() const { return heap_.size(); }
  std::int64_t top_position() const { return heap_.top().position; }
  void push(const StepGraph& graph, Task task) { heap_.push({stage_position(graph, task), task}); }
  Task pop() {
    const Task task = heap_.top().task;
    heap_.pop();
    return task;
  }

 private:
  struct Entry {
    std::int64_t position;
    Task task;
    bool operator<(const Entry& other) const {  // the heap's top is its largest
      return position != other.position ? position > other.position : task.node > other.task.node;
    }
  };
  std::priority_queue<Entry> heap_;
};

}  // namespace moraine::runtime
