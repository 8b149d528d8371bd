// SPDX-License-Identifier: Apache-2.0
// Replays against makespans worked out by hand, and against bounds that no schedule can break.
#include "runtime/replay/replay.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "runtime/balance/registry.hpp"
#include "runtime/replay/rearrange.hpp"
#include "runtime/schedule/registry.hpp"
#include "runtime/trace/trace_file.hpp"

namespace moraine::runtime {
namespace {

/// Sub-models that all take `seconds` in each stage and round.
Workload even_work(std::size_t sub_models, std::vector<int> receives, std::int64_t rounds, double seconds = 1) {
  Workload w;
  w.sub_models = sub_models;
  w.settings.sub_models = static_cast<std::int64_t>(sub_models);
  w.settings.receives = std::move(receives);
  for (std::size_t s = 0; s < w.settings.receives.size(); ++s) w.settings.stages.push_back("stage");
  w.settings.scheduler = "hybrid";
  w.settings.balancer = "none";
  w.settings.threads = {1};
  WorkEpoch e;
  e.span = {0, rounds};
  e.cost.assign(w.nodes(), 1.0);
  e.memory.assign(sub_models, 0.0);
  e.seconds.assign(w.nodes() * static_cast<std::size_t>(rounds + 1), seconds);
  e.owner.assign(sub_models, 0);
  w.epochs.push_back(e);
  return w;
}

void link(Workload& w, SubModelId from, SubModelId to, int read_in, double bytes = 0) {
  const int sent_in = w.settings.receives[static_cast<std::size_t>(read_in)];
  for (WorkEpoch& e : w.epochs) {
    e.messages.push_back({{from, sent_in, to, read_in}, bytes});
    std::ranges::sort(e.messages, {}, &SizedMessage::message);
  }
}

/// In a row, each waiting for both neighbours of the round before.
Workload row(std::size_t sub_models, std::int64_t rounds, double bytes = 0) {
  Workload w = even_work(sub_models, {0}, rounds);
  for (SubModelId s = 0; s + 1 < sub_models; ++s) {
    link(w, s, s + 1, 0, bytes);
    link(w, s + 1, s, 0, bytes);
  }
  return w;
}

ReplayOptions on(int ranks, int threads, const std::string& scheduler) {
  ReplayOptions o;
  o.machine.ranks = ranks;
  o.machine.threads = threads;
  o.machine.scheduler = scheduler;
  o.machine.latency = 0;
  o.balancer = "none";
  return o;
}

TEST(Replay, BarrierLeavesAQuarterOfTwoWorkersIdleWithThreeSubModels) {
  const Prediction p = replay(row(3, 39), on(1, 2, "barrier"));
  EXPECT_DOUBLE_EQ(p.makespan, 80);
  EXPECT_DOUBLE_EQ(p.utilisation, 0.75);
}

TEST(Replay, BarrierLeavesAnEighthIdleWithSeven) {
  EXPECT_DOUBLE_EQ(replay(row(7, 39), on(1, 2, "barrier")).utilisation, 0.875);
  EXPECT_GT(replay(row(7, 39), on(1, 2, "hybrid")).utilisation, 0.98);
}

TEST(Replay, FourteenOnEightThreadsOfEightRanks) {
  const Prediction p = replay(row(112, 19), on(8, 8, "barrier"));
  EXPECT_DOUBLE_EQ(p.makespan, 40);
  EXPECT_DOUBLE_EQ(p.utilisation, 0.875);
}

TEST(Replay, MessagesBetweenRanksTakeLatencyAndBytesOverBandwidth) {
  ReplayOptions o = on(2, 1, "hybrid");
  o.machine.latency = 0.25;
  o.machine.bandwidth = 1000;
  const Prediction p = replay(row(2, 9, 500), o);
  EXPECT_DOUBLE_EQ(p.tasks_span, 10 + 9 * (0.25 + 0.5));
  EXPECT_DOUBLE_EQ(p.makespan, p.tasks_span + 2 * 0.25);  // and agreeing on the end of the epoch
  EXPECT_EQ(p.messages, 2 * 9);                           // those of the last round have no reader
  EXPECT_EQ(p.bytes, 2 * 9 * 500);
}

TEST(Replay, MessagesOfOneRankQueue) {
  Workload w = even_work(3, {Stage::none, 0}, 0);  // 0 tells 1 and 2, which wait in their second stage
  link(w, 0, 1, 1, 100);
  link(w, 0, 2, 1, 100);
  ReplayOptions o = on(3, 1, "hybrid");
  o.machine.bandwidth = 100;
  EXPECT_DOUBLE_EQ(replay(w, o).makespan, 1 + 2 + 1);
}

TEST(Replay, MessagesWithinARankAreFree) {
  ReplayOptions o = on(1, 2, "hybrid");
  o.machine.latency = 5;
  const Prediction p = replay(row(2, 9, 500), o);
  EXPECT_DOUBLE_EQ(p.makespan, 10);
  EXPECT_EQ(p.messages, 0);
}

TEST(Replay, AChainRunsAtTheSpeedOfItsSlowestLink) {
  Workload w = even_work(3, {0}, 9);  // 0 -> 1 -> 2: nobody waits for an answer but for free slots
  link(w, 0, 1, 0);
  link(w, 1, 2, 0);
  ReplayOptions o = on(3, 1, "hybrid");
  o.machine.latency = 10;
  // Round r of 1 waits for round r - 1 of 0, which ends at r: it ends at r + 11. Round r of 2 ends 11 after that of
  // round r - 1 of 1.
  EXPECT_DOUBLE_EQ(replay(w, o).tasks_span, 9 - 1 + 11 + 11);
}

TEST(Replay, RanksThatShareACoreTakeTurns) {
  ReplayOptions o = on(2, 1, "hybrid");
  o.machine.cores = 1;
  const Prediction p = replay(even_work(2, {Stage::none}, 4), o);
  EXPECT_DOUBLE_EQ(p.makespan, 10);
  EXPECT_DOUBLE_EQ(p.utilisation, 1);
}

TEST(Replay, SharedCoresSlowOnlyWhatRunsTogether) {
  Workload w = even_work(2, {Stage::none}, 0);
  w.epochs[0].seconds = {1, 3};
  ReplayOptions o = on(2, 1, "hybrid");
  o.machine.cores = 1;
  EXPECT_DOUBLE_EQ(replay(w, o).makespan, 4);
  o.machine.cores = 2;
  EXPECT_DOUBLE_EQ(replay(w, o).makespan, 3);
}

TEST(Replay, TasksCostOverheadsAsMeasured) {
  ReplayOptions o = on(1, 1, "hybrid");
  o.machine.overheads.next = 0.5;
  EXPECT_DOUBLE_EQ(replay(even_work(1, {Stage::none}, 9), o).makespan, 10 + 9 * 0.5);
}

TEST(Replay, FasterCoresShortenTasks) {
  ReplayOptions o = on(1, 2, "barrier");
  o.machine.speed = 4;
  EXPECT_DOUBLE_EQ(replay(row(3, 39), o).makespan, 20);
}

TEST(Replay, CopiesSideBySideAreJoinedAtTheirEnds) {
  const Workload w = row(4, 9);
  const auto messages = side_by_side(w.epochs[0], 4, 3);
  EXPECT_EQ(messages.size(), 3 * 6 + 2 * 2);
  const auto joins = [&](SubModelId a, SubModelId b) {
    return std::ranges::any_of(messages, [&](const SizedMessage& m) { return m.message == Message{a, 0, b, 0}; });
  };
  for (const SubModelId a : {3U, 7U}) {
    EXPECT_TRUE(joins(a, a + 1));
    EXPECT_TRUE(joins(a + 1, a));
  }
  EXPECT_FALSE(joins(3, 7));
}

TEST(Replay, CopiesOnAsManyRanksTakeAsLong) {
  const Workload w = row(6, 19);
  ReplayOptions o = on(50, 2, "hybrid");
  o.copies = 50;
  const Prediction many = replay(w, o), one = replay(w, on(1, 2, "hybrid"));
  EXPECT_EQ(many.tasks, 50 * one.tasks);
  EXPECT_NEAR(many.makespan, one.makespan, 2);
}

/// The work of an epoch after another; sub-models from `heavy_from` on take ten times as long.
Workload uneven_epochs(std::size_t epochs) {
  Workload w = row(8, 9);
  for (SubModelId s = 6; s < 8; ++s) {
    w.epochs[0].cost[s] = 10e6;  // as counted: a microsecond each
    for (std::int64_t r = 0; r <= 9; ++r) w.epochs[0].seconds[static_cast<std::size_t>(r) * 8 + s] = 10;
  }
  for (SubModelId s = 0; s < 6; ++s) w.epochs[0].cost[s] = 1e6;
  for (std::size_t e = 1; e < epochs; ++e) {
    w.epochs.push_back(w.epochs[0]);
    w.epochs[e].span.first_round = static_cast<std::int64_t>(e) * 9;
  }
  return w;
}

TEST(Replay, ARealBalancerMovesWhatIsHeavyAndPaysForIt) {
  const Workload w = uneven_epochs(6);
  ReplayOptions o = on(2, 1, "hybrid");
  const Prediction still = replay(w, o);
  EXPECT_EQ(still.migrations, 0);
  for (const BalancerRow& balancer : balancers()) {
    o.balancer = balancer.name;
    if (balancer.forced || balancer.name == "none") continue;
    const Prediction moved = replay(w, o);
    EXPECT_GE(moved.migrations, 1) << balancer.name;
    EXPECT_LT(moved.makespan, 0.9 * still.makespan) << balancer.name;
    EXPECT_GT(moved.balancing, 0) << balancer.name;
    EXPECT_DOUBLE_EQ(moved.work, still.work);
  }
}

TEST(Replay, WhatHappensBetweenEpochsIsKept) {
  Workload w = row(3, 9);
  w.epochs[0].between.phase[static_cast<std::size_t>(Phase::settle)] = 6;
  w.epochs[0].between.phase[static_cast<std::size_t>(Phase::output)] = 1;
  EXPECT_DOUBLE_EQ(replay(w, on(1, 1, "hybrid")).makespan, 30 + 7);
  EXPECT_DOUBLE_EQ(replay(w, on(3, 1, "hybrid")).between, 6.0 / 3 + 1);
}

TEST(Replay, RefusesWhatMakesNoSense) {
  const Workload w = row(3, 9);
  EXPECT_THROW(replay(w, on(0, 1, "hybrid")), std::invalid_argument);
  EXPECT_THROW(replay(w, on(1, 1, "fastest")), std::invalid_argument);
  ReplayOptions o = on(1, 1, "hybrid");
  o.machine.bandwidth = 0;
  EXPECT_THROW(replay(w, o), std::invalid_argument);
}

/// Any stages, neighbours, costs.
Workload random_work(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> receives{Stage::none};
  const int stages = 1 + static_cast<int>(random() % 4);
  for (int s = 1; s < stages; ++s) receives.push_back(random() % 3 == 0 ? Stage::none : s - 1);
  if (stages == 1 || receives[static_cast<std::size_t>(stages - 1)] == stages - 2) receives[0] = stages - 1;
  Workload w = even_work(1 + random() % 12, receives, 1 + static_cast<std::int64_t>(random() % 8));
  for (double& s : w.epochs[0].seconds) s = static_cast<double>(random() % 100) / 10;
  for (int t = 0; t < stages; ++t)
    for (SubModelId from = 0; from < w.sub_models && receives[static_cast<std::size_t>(t)] != Stage::none; ++from)
      for (SubModelId to = 0; to < w.sub_models; ++to)
        if (random() % w.sub_models < 2) link(w, from, to, t, static_cast<double>(random() % 1000));
  return w;
}

/// The costliest chain of tasks, by stages in order and messages alone.
double critical_path(const Workload& w) {
  const WorkEpoch& e = w.epochs[0];
  const std::size_t nodes = w.nodes(), stages = w.stages();
  std::vector<double> end(e.seconds.size(), 0.0);
  for (std::size_t round = 0; round * nodes < end.size(); ++round)
    for (std::size_t stage = 0; stage < stages; ++stage)
      for (std::size_t s = 0; s < w.sub_models; ++s) {
        const std::size_t at = round * nodes + s * stages + stage;
        double begin = stage > 0 ? end[at - 1] : round > 0 ? end[at - nodes + stages - 1] : 0.0;
        for (const auto& [m, bytes] : e.messages) {
          if (m.to != s || static_cast<std::size_t>(m.read_in) != stage || (m.next_round() && round == 0)) continue;
          const std::size_t sent = (m.next_round() ? round - 1 : round) * nodes + m.from * stages;
          begin = std::max(begin, end[sent + static_cast<std::size_t>(m.sent_in)]);
        }
        end[at] = begin + e.seconds[at];
      }
  return *std::ranges::max_element(end);
}

TEST(Replay, NoScheduleBeatsItsBounds) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Workload w = random_work(seed);
    std::mt19937 random(seed);
    for (const SchedulerRow& scheduler : schedulers()) {
      ReplayOptions o =
          on(1 + static_cast<int>(random() % 5), 1 + static_cast<int>(random() % 3), std::string(scheduler.name));
      o.machine.cores = random() % 2 == 0 ? 0 : 1 + static_cast<int>(random() % 4);
      o.machine.latency = static_cast<double>(random() % 3);
      const Prediction p = replay(w, o);
      ASSERT_EQ(p.tasks, static_cast<std::int64_t>(w.epochs[0].seconds.size())) << seed;
      ASSERT_NEAR(p.work, w.seconds(), 1e-9 * w.seconds());
      ASSERT_GE(p.makespan * (1 + 1e-12), std::max(p.work / o.machine.capacity(), critical_path(w)))
          << scheduler.name << ", seed " << seed;
      ASSERT_EQ(replay(w, o).makespan, p.makespan) << "not the same again";
    }
  }
}

Trace traced(double seconds) {
  Trace t;
  t.settings.sub_models = 1;
  t.settings.stages = {"move"};
  t.settings.receives = {Stage::none};
  t.settings.threads = {1};
  t.settings.scheduler = "hybrid";
  t.settings.balancer = "none";
  t.lists.epochs.push_back({.first_round = 0, .rounds = 1, .epoch = 4});
  t.lists.owners.push_back({.epoch = 4, .sub_model = 0, .rank = 0, .memory = 10});
  double now = 1;
  t.lists.phases.push_back({.start = 0, .end = 1, .epoch = 4, .phase = Phase::settle});
  for (int r = 0; r < 2; ++r) {
    TaskRecord task{.start = now, .end = now + seconds, .ready = r == 0 ? 0 : now, .in_epoch = r, .epoch = 4};
    t.lists.tasks.push_back(task);
    now += seconds;
  }
  t.lists.phases.push_back({.start = 1, .end = now + 0.5, .epoch = 4, .phase = Phase::work});
  return t;
}

TEST(Workload, ReadsATrace) {
  const Workload w = workload_of(traced(2));
  ASSERT_EQ(w.epochs.size(), 1U);
  EXPECT_EQ(w.epochs[0].seconds, (std::vector<double>{2, 2}));
  EXPECT_DOUBLE_EQ(w.epochs[0].between.phase[static_cast<std::size_t>(Phase::settle)], 1);
  EXPECT_DOUBLE_EQ(w.epochs[0].between.phase[static_cast<std::size_t>(Phase::work)], 0.5);
  EXPECT_DOUBLE_EQ(w.traced_makespan, 5.5);
  EXPECT_DOUBLE_EQ(replay(w, on(1, 1, "hybrid")).makespan, 5.5);
}

TEST(Workload, CountsTimeWithACoreWhereCoresAreShared) {
  Trace t = traced(2);
  for (TaskRecord& task : t.lists.tasks) task.processor = 0.75;
  t.settings.cores = {1};
  EXPECT_EQ(workload_of(t).epochs[0].seconds, (std::vector<double>{2, 2}));
  EXPECT_EQ(as_traced(workload_of(t)).machine.cores, 0);
  t.settings.threads = {3};
  EXPECT_EQ(workload_of(t).epochs[0].seconds, (std::vector<double>{0.75, 0.75}));
  EXPECT_EQ(as_traced(workload_of(t)).machine.cores, 1);
  t.lists.phases.back().processor = 3;  // twice what the tasks had
  EXPECT_EQ(workload_of(t).epochs[0].seconds, (std::vector<double>{1.5, 1.5}));
}

TEST(Workload, RefusesTracesThatItCannotReplay) {
  Trace incomplete = traced(2);
  incomplete.lists.tasks.pop_back();
  EXPECT_THROW(workload_of(incomplete), TraceError);
  Trace strange = traced(2);
  strange.lists.tasks[0].sub_model = 7;
  EXPECT_THROW(workload_of(strange), TraceError);
}

}  // namespace
}  // namespace moraine::runtime
