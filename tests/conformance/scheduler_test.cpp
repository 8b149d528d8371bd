// SPDX-License-Identifier: Apache-2.0
// What every scheduler in the table must do, and how well those worth choosing do, in simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "runtime/schedule/registry.hpp"
#include "runtime/schedule/simulated_machine.hpp"
#include "runtime/simulation.hpp"
#include "tests/support/gossip_model.hpp"

namespace moraine::runtime {
namespace {

using test::GossipModel;
using test::RandomGossip;

std::vector<std::string> scheduler_names() {
  std::vector<std::string> names;
  for (const SchedulerRow& row : schedulers()) names.emplace_back(row.name);
  return names;
}

SimulatedRun simulated(const std::string& scheduler, const StepGraph& graph, int workers, std::int64_t rounds) {
  const auto policy = find_scheduler(scheduler).make();
  return simulate(*policy, graph, workers, rounds, [&](Task task) { return graph.cost[task.node]; });
}

/// Start and end by task.
class Times {
 public:
  Times(const StepGraph& graph, const SimulatedRun& run) : nodes_(graph.node_count()), of_(run.tasks.size()) {
    std::vector<bool> done(run.tasks.size(), false);
    for (const SimulatedTask& t : run.tasks) {
      EXPECT_FALSE(done.at(index(t.task))) << "done twice";
      done.at(index(t.task)) = true;
      of_[index(t.task)] = t;
    }
  }
  void expect_order(Task before, Task after) const { EXPECT_LE(of_[index(before)].end, of_[index(after)].start); }

 private:
  std::size_t index(Task task) const { return static_cast<std::size_t>(task.round) * nodes_ + task.node; }
  std::size_t nodes_;
  std::vector<SimulatedTask> of_;
};

void expect_links_hold(const StepGraph& graph, const Times& times, std::int64_t rounds) {
  for (std::int64_t r = 0; r < rounds; ++r) {
    for (NodeId node = 0; node < graph.node_count(); ++node) {
      for (const NodeId next : graph.same_round.of(node)) times.expect_order({node, r}, {next, r});
      if (r + 1 == rounds) continue;
      for (const NodeId next : graph.next_round.of(node)) times.expect_order({node, r}, {next, r + 1});
    }
  }
}

void expect_one_task_per_worker(const SimulatedRun& run) {
  std::vector<double> free(run.busy.size(), 0.0);
  for (const SimulatedTask& t : run.tasks) {
    EXPECT_GE(t.start, free.at(static_cast<std::size_t>(t.worker)));
    free[static_cast<std::size_t>(t.worker)] = t.end;
  }
}

/// Sub-models side by side, each telling its neighbours where it is before all move.
StepGraph chain(std::size_t size) {
  GossipModel model(size, {{"step", 0}});
  for (SubModelId from = 0; from < size; ++from)
    for (SubModelId to = 0; to < size; ++to)
      if (from + 1 == to || to + 1 == from) model.link(from, to, 0);
  return build_step_graph(model);
}

class Scheduling : public testing::TestWithParam<std::string> {};

TEST_P(Scheduling, EveryTaskOnceAndInOrderWhateverTheCosts) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    RandomGossip model(seed, 1 + seed % 9);
    model.begin_epoch(0, 1);
    StepGraph graph = build_step_graph(model);
    for (double& cost : graph.cost) cost = double(random() % 100);
    const int workers = 1 + static_cast<int>(random() % 6);
    const SimulatedRun run = simulated(GetParam(), graph, workers, 11);
    ASSERT_EQ(run.tasks.size(), graph.node_count() * 11);
    expect_links_hold(graph, Times(graph, run), 11);
    expect_one_task_per_worker(run);
  }
}

TEST_P(Scheduling, DoesTheSameAgain) {
  RandomGossip model(3, 7);
  model.begin_epoch(0, 1);
  const StepGraph graph = build_step_graph(model);
  const auto policy = find_scheduler(GetParam()).make();
  const auto duration = [&](Task task) { return 1.0 + double(task.node % 3); };
  const SimulatedRun first = simulate(*policy, graph, 3, 9, duration);
  const SimulatedRun second = simulate(*policy, graph, 3, 9, duration);
  ASSERT_EQ(first.tasks.size(), second.tasks.size());
  for (std::size_t i = 0; i < first.tasks.size(); ++i) {
    EXPECT_EQ(first.tasks[i].task, second.tasks[i].task);
    EXPECT_EQ(first.tasks[i].worker, second.tasks[i].worker);
  }
}

TEST_P(Scheduling, OneWorkerIsAlwaysBusy) {
  EXPECT_NEAR(simulated(GetParam(), chain(5), 1, 10).utilisation(), 1.0, 1e-12);
}

TEST_P(Scheduling, RunsRealThreadsToTheSameMemories) {
  RandomGossip alone(11, 6);
  Simulation(alone, {.threads = 1, .scheduler = "serial"}).run(0, 40);
  for (const int threads : {1, 2, 5, 9}) {
    RandomGossip model(11, 6);
    Simulation(model, {.threads = threads, .scheduler = GetParam(), .check_messages = true}).run(0, 40);
    EXPECT_EQ(model.memories(), alone.memories());
  }
}

void expect_utilisation(const std::string& scheduler, std::size_t sub_models, double barrier) {
  const double utilisation = simulated(scheduler, chain(sub_models), 2, 41).utilisation();
  if (scheduler == "serial") {
    EXPECT_NEAR(utilisation, 0.5, 1e-12);
  } else if (scheduler == "barrier") {
    EXPECT_NEAR(utilisation, barrier, 0.01);
  } else {
    EXPECT_GE(utilisation, 0.95);
  }
}

TEST_P(Scheduling, IsKeptBusyByThreeSubModelsOnTwoWorkers) { expect_utilisation(GetParam(), 3, 0.75); }

TEST_P(Scheduling, IsKeptBusyBySevenSubModelsOnTwoWorkers) { expect_utilisation(GetParam(), 7, 0.875); }

/// 15 units of work a round for three workers, 4 of them in one sub-model.
TEST_P(Scheduling, OneLongTaskDoesNotHoldUpTheRest) {
  const double least = GetParam() == "serial" ? 0.33 : GetParam() == "barrier" ? 0.71 : 0.9;
  StepGraph graph = chain(12);
  graph.cost[3] = 4.0;
  EXPECT_GE(simulated(GetParam(), graph, 3, 41).utilisation(), least);
}

INSTANTIATE_TEST_SUITE_P(All, Scheduling, testing::ValuesIn(scheduler_names()),
                         [](const auto& test) { return test.param; });

TEST(SchedulerTable, HasUniqueNamesWithHelp) {
  std::set<std::string_view> names;
  for (const SchedulerRow& row : schedulers()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_FALSE(row.help.empty());
    EXPECT_EQ(row.help.find('\n'), std::string_view::npos);
    EXPECT_EQ(find_scheduler(row.name).make, row.make);
  }
}

TEST(SchedulerTable, ListsItselfIfAskedForAnother) {
  try {
    find_scheduler("fastest");
    FAIL();
  } catch (const std::invalid_argument& error) {
    for (const SchedulerRow& row : schedulers())
      EXPECT_NE(std::string(error.what()).find(row.name), std::string::npos) << row.name;
  }
}

}  // namespace
}  // namespace moraine::runtime
