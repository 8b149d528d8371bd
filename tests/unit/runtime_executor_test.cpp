// SPDX-License-Identifier: Apache-2.0
// Real threads: order, messages, errors, extremes, load.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "runtime/run_error.hpp"
#include "runtime/schedule/registry.hpp"
#include "runtime/simulation.hpp"
#include "tests/support/gossip_model.hpp"

namespace moraine::runtime {
namespace {

using test::GossipModel;
using test::RandomGossip;

Options options(std::string_view scheduler, int threads) {
  return {.threads = threads, .scheduler = std::string(scheduler), .measured_cost = false, .check_messages = true};
}

std::vector<std::uint64_t> memories_after(unsigned seed, std::size_t size, const Options& chosen) {
  RandomGossip model(seed, size);
  Simulation(model, chosen).run(5, 30);
  return model.memories();
}

TEST(Executor, RandomNeighboursHearTheSameFromAnyScheduler) {
  for (unsigned seed = 0; seed < 25; ++seed) {
    const std::size_t size = 1 + seed % 8;
    const auto expected = memories_after(seed, size, options("serial", 1));
    for (const SchedulerRow& row : schedulers())
      for (const int threads : {1, 2, 3, 8})
        ASSERT_EQ(memories_after(seed, size, options(row.name, threads)), expected)
            << row.name << " on " << threads << ", seed " << seed;
  }
}

TEST(Executor, ManySubModels) {
  for (const SchedulerRow& row : schedulers())
    EXPECT_EQ(memories_after(77, 300, options(row.name, 3)), memories_after(77, 300, options("serial", 1))) << row.name;
}

TEST(Executor, NoSubModels) {
  for (const SchedulerRow& row : schedulers()) {
    GossipModel model(0, {{"a"}, {"b", 0}});
    Simulation simulation(model, options(row.name, 2));
    simulation.run(0, 10);
    EXPECT_EQ(simulation.load().tasks(), 0);
    EXPECT_EQ(simulation.load().utilisation(), 1.0);
  }
}

TEST(Executor, NoStagesAndNoRounds) {
  GossipModel model(3, {});
  Simulation simulation(model, options("hybrid", 2));
  simulation.run(0, 10);
  simulation.run(10, 0);
  EXPECT_EQ(simulation.load().tasks(), 0);
}

TEST(Executor, OneSubModelOnManyWorkers) {
  for (const SchedulerRow& row : schedulers()) {
    GossipModel model(1, {{"a"}, {"b"}});
    Simulation simulation(model, options(row.name, 16));
    simulation.run(0, 50);
    EXPECT_EQ(simulation.load().tasks(), 2 * 51);
  }
}

TEST(Executor, RefusesSettingsThatMakeNoSense) {
  GossipModel model(1, {{"a"}});
  EXPECT_THROW(Simulation(model, options("hybrid", -1)), std::invalid_argument);
  EXPECT_THROW(Simulation(model, options("fastest", 1)), std::invalid_argument);
}

struct TooHot : std::runtime_error {
  using std::runtime_error::runtime_error;
};

TEST(Executor, SaysWhichTaskFailedAndWhy) {
  for (const SchedulerRow& row : schedulers()) {
    GossipModel model(4, {{"warm"}, {"move"}});
    model.sub_model(2).on_task = [](int stage, const Round& round) {
      if (stage == 1 && round.number == 17) throw TooHot("999 K");
    };
    try {
      Simulation(model, options(row.name, 3)).run(10, 20);
      FAIL() << row.name;
    } catch (const RunError& error) {
      EXPECT_STREQ(error.what(), "rank 0, move of sub-model 2 in round 17: 999 K");
      EXPECT_EQ(error.failure().stage, "move");
      EXPECT_EQ(error.failure().sub_model, 2U);
      EXPECT_EQ(error.failure().round.number, 17);
      EXPECT_THROW(std::rethrow_exception(error.cause()), TooHot);
    }
  }
}

TEST(Executor, FailureInTheOpeningRoundSaysSo) {
  GossipModel model(1, {{"warm"}});
  model.sub_model(0).on_task = [](int, const Round&) { throw 42; };
  try {
    Simulation(model, options("hybrid", 1)).run(8, 1);
    FAIL();
  } catch (const RunError& error) {
    EXPECT_STREQ(error.what(), "rank 0, warm of sub-model 0 in the exchange before round 8: unknown error");
    EXPECT_THROW(std::rethrow_exception(error.cause()), int);
  }
}

/// Returns when both of two tasks are at work, so that either may fail without keeping the other from starting.
void meet(std::atomic<int>& here) {
  ++here;
  while (here < 2) std::this_thread::yield();
}

TEST(Executor, OfSeveralFailuresTheFirstInOrderCounts) {
  std::atomic<int> here = 0;
  GossipModel model(2, {{"warm"}});
  model.sub_model(0).on_task = [&](int, const Round&) {
    meet(here);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    throw TooHot("late");
  };
  model.sub_model(1).on_task = [&](int, const Round&) {
    meet(here);
    throw TooHot("early");
  };
  try {
    Simulation(model, options("hybrid", 2)).run(0, 1);
    FAIL();
  } catch (const RunError& error) {
    EXPECT_EQ(error.failure().sub_model, 0U);
  }
}

TEST(Executor, StartsNothingAfterAFailureAndCanRunAgain) {
  GossipModel model(3, {{"a"}});
  const StepGraph graph = build_step_graph(model);
  Executor executor(2, find_scheduler("stealing").make());
  std::atomic<int> done = 0;
  const auto fail_once = [&](Task, int) {
    if (done++ == 0) throw TooHot("first");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  EXPECT_THROW(executor.run(graph, {0, 1000}, fail_once), RunError);
  EXPECT_LE(done, 100);
  const LoadRecord load = executor.run(graph, {0, 100}, fail_once);
  EXPECT_EQ(load.tasks(), 3 * 101);
}

/// Two tasks meet if two threads run them; one thread alone waits in vain.
bool two_tasks_meet(Executor& executor, const StepGraph& graph) {
  std::atomic<int> here = 0;
  std::atomic<bool> met = false;
  executor.run(graph, {0, 0}, [&](Task, int) {
    ++here;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (here < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    met = std::chrono::steady_clock::now() < deadline;
  });
  return met;
}

TEST(Executor, LendsThreadsToEachExecutorAfterAnother) {
  GossipModel model(2, {{"a"}});
  const StepGraph graph = build_step_graph(model);
  for (const int workers : {1, 2, 4, 1, 2, 3, 2, 1, 2}) {
    Executor executor(workers, find_scheduler("hybrid").make());
    executor.run(graph, {0, 1}, [](Task, int) {});
    if (workers == 1) continue;
    EXPECT_TRUE(two_tasks_meet(executor, graph)) << workers;
  }
}

/// Keeps everything to itself.
class Miser final : public Scheduler {
 public:
  void begin(const StepGraph&, int, std::int64_t) override {}
  void ready(Task, int) override {}
  std::optional<Task> next(int) override { return std::nullopt; }
};

/// Hands out the last stage first.
class Hasty final : public Scheduler {
 public:
  void begin(const StepGraph& graph, int, std::int64_t) override {
    last_ = static_cast<NodeId>(graph.node_count() - 1);
  }
  void ready(Task, int) override {}
  std::optional<Task> next(int) override { return Task{last_, 0}; }

 private:
  NodeId last_ = 0;
};

/// Is generous once.
class Quitter final : public Scheduler {
 public:
  void begin(const StepGraph&, int, std::int64_t) override {}
  void ready(Task task, int) override { task_ = task; }
  std::optional<Task> next(int) override { return std::exchange(gone_, true) ? std::nullopt : task_; }

 private:
  std::optional<Task> task_;
  bool gone_ = false;
};

TEST(Executor, NoticesSchedulersThatBreakTheirContract) {
  GossipModel model(1, {{"a"}, {"b"}});
  const StepGraph graph = build_step_graph(model);
  const auto nothing = [](Task, int) {};
  EXPECT_THROW(Executor(1, std::make_unique<Miser>()).run(graph, {0, 3}, nothing), std::logic_error);
  EXPECT_THROW(Executor(1, std::make_unique<Hasty>()).run(graph, {0, 3}, nothing), std::logic_error);
  EXPECT_THROW(Executor(2, std::make_unique<Quitter>()).run(graph, {0, 3}, nothing), std::logic_error);
}

class Listener final : public TaskObserver {
 public:
  void task_done(const TaskRecord& record) override {
    const std::lock_guard lock(mutex_);
    ++seen[{record.stage, record.sub_model, record.in_epoch}];
    EXPECT_LE(record.ready, record.handed);
    EXPECT_LE(record.handed, record.start);
    EXPECT_LE(record.start, record.end);
    EXPECT_EQ(record.round, 100 + std::max(0, record.in_epoch - 1));
    EXPECT_TRUE(record.worker == 0 || record.worker == 1);
  }
  std::map<std::tuple<int, SubModelId, std::int64_t>, int> seen;

 private:
  std::mutex mutex_;
};

TEST(Executor, TellsItsObserverEveryTaskOnce) {
  GossipModel model(3, {{"a"}, {"b"}});
  Listener listener;
  Executor executor(2, find_scheduler("hybrid").make());
  executor.run(
      build_step_graph(model), {100, 9}, [](Task, int) {}, &listener);
  EXPECT_EQ(listener.seen.size(), 2U * 3 * 10);
  for (const auto& [task, times] : listener.seen) EXPECT_EQ(times, 1);
}

TEST(Executor, MeasuresLoad) {
  GossipModel model(2, {{"a"}, {"b"}});
  for (SubModelId id = 0; id < 2; ++id)
    model.sub_model(id).on_task = [](int stage, const Round&) {
      if (stage == 1) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    };
  Simulation simulation(model, options("barrier", 1));
  simulation.run(0, 5);
  simulation.run(5, 5);
  const LoadRecord& load = simulation.load();
  EXPECT_EQ(load.tasks(), 2 * 2 * 12);
  EXPECT_GE(load.stages[1].taken.seconds, 0.002 * 24);
  EXPECT_LT(load.stages[0].taken.seconds, load.stages[1].taken.seconds);
  EXPECT_GE(load.elapsed, load.busy());
  EXPECT_GT(load.utilisation(), 0.5);
  EXPECT_EQ(load.imbalance(), 1.0);
  EXPECT_GE(load.mean_cost(build_step_graph(model))[3], 0.002);
}

/// Where ranks are several, those who sleep are not busy: nor are those who wait for a core.
TEST(Executor, MeasuresProcessorTime) {
  GossipModel model(1, {{"a"}});
  const StepGraph graph = build_step_graph(model);
  for (const bool processor_time : {false, true}) {
    Executor executor(1, find_scheduler("serial").make(), {.processor_time = processor_time});
    const Busy busy =
        executor.run(graph, {0, 5}, [&](Task, int) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); })
            .workers[0];
    EXPECT_GE(busy.taken.seconds, 0.005 * 6);
    if (processor_time)
      EXPECT_LT(busy.taken.processor, 0.5 * busy.taken.seconds);
    else
      EXPECT_EQ(busy.taken.processor, busy.taken.seconds);
  }
}

TEST(LoadRecord, ComparesWorkers) {
  GossipModel model(1, {{"a"}});
  const StepGraph graph = build_step_graph(model);
  LoadRecord load(graph, 2);
  load.elapsed = 10;
  load.add(graph, {0, 0}, 0, {9, 6});
  LoadRecord more(graph, 2);
  more.elapsed = 10;
  more.add(graph, {0, 0}, 1, {3, 2});
  load.merge(more);
  EXPECT_DOUBLE_EQ(load.utilisation(), 0.3);
  EXPECT_DOUBLE_EQ(load.waiting_fraction(), 0.7);
  EXPECT_DOUBLE_EQ(load.imbalance(), 1.5);
  EXPECT_EQ(load.mean_cost(graph), std::vector<double>{6});
  EXPECT_EQ(load.processor_of(0), 8);
}

}  // namespace
}  // namespace moraine::runtime
