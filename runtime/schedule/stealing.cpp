// SPDX-License-Identifier: Apache-2.0
// Every worker goes on with what it released first; one that has nothing takes the oldest task of the fullest worker.
// Latest first, as with independent tasks, would let some sub-models run ahead until the others, one behind the other,
// keep a single worker busy: 7 sub-models in a row then use two workers to 88 %, oldest first to 99 %.
#include <algorithm>
#include <deque>

#include "runtime/schedule/policies.hpp"

namespace moraine::runtime {
namespace {

class Stealing final : public Scheduler {
 public:
  void begin(const StepGraph& graph, int workers, std::int64_t) override {
    graph_ = &graph;
    tasks_.resize(static_cast<std::size_t>(workers));
    for (auto& tasks : tasks_) tasks.clear();
  }

  void ready(Task task, int released_by) override {
    const std::size_t worker = released_by == nobody ? graph_->place(task.node) * tasks_.size() / graph_->sub_models
                                                     : static_cast<std::size_t>(released_by);
    tasks_[worker].push_back(task);
  }

  std::optional<Task> next(int worker) override {
    auto& own = tasks_[static_cast<std::size_t>(worker)];
    if (own.empty()) return steal();
    return pop_oldest(own);
  }

 private:
  std::optional<Task> steal() {
    const auto fullest = std::max_element(tasks_.begin(), tasks_.end(),
                                          [](const auto& a, const auto& b) { return a.size() < b.size(); });
    if (fullest->empty()) return std::nullopt;
    return pop_oldest(*fullest);
  }

  static Task pop_oldest(std::deque<Task>& tasks) {
    const Task task = tasks.front();
    tasks.pop_front();
    return task;
  }

  const StepGraph* graph_ = nullptr;
  std::vector<std::deque<Task>> tasks_;  ///< per worker, latest at the back
};

}  // namespace

std::unique_ptr<Scheduler> make_stealing() { return std::make_unique<Stealing>(); }

}  // namespace moraine::runtime
