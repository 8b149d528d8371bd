// SPDX-License-Identifier: Apache-2.0
// Profiles of traces whose figures can be worked out by hand.
#include "runtime/profile/profile.hpp"

#include <gtest/gtest.h>

#include "runtime/profile/verdict.hpp"
#include "runtime/sub_model.hpp"
#include "runtime/trace/trace_file.hpp"

namespace moraine::runtime {
namespace {

Trace empty_trace(int ranks, int threads, std::int64_t sub_models) {
  Trace t;
  t.settings.scheduler = "hybrid";
  t.settings.balancer = "none";
  t.settings.predictor = "median";
  t.settings.sub_models = sub_models;
  t.settings.threads.assign(static_cast<std::size_t>(ranks), threads);
  t.settings.cores.assign(static_cast<std::size_t>(ranks), threads);
  t.settings.stages = {"move"};
  t.settings.receives = {0};
  return t;
}

void work(Trace& t, int rank, double start, double end, std::uint32_t epoch = 0) {
  t.lists.phases.push_back({.start = start, .end = end, .epoch = epoch, .rank = rank, .phase = Phase::work});
}

/// One rank, two workers. Round 0: sub-model 0 takes 10 s, 1 takes 1 s. Both are awaited by round 1 of both, 1 s each.
Trace one_heavy() {
  Trace t = empty_trace(1, 2, 2);
  t.lists.epochs.push_back({.first_round = 0, .rounds = 1, .epoch = 0});
  work(t, 0, 0, 12);
  t.lists.tasks = {
      {.start = 0, .end = 10, .sub_model = 0, .worker = 0},
      {.start = 10,
       .end = 11,
       .sent = 10,
       .ready = 10,
       .handed = 10,
       .in_epoch = 1,
       .sub_model = 0,
       .worker = 0,
       .release = Release::task,
       .released_before = true},
      {.start = 0, .end = 1, .sub_model = 1, .worker = 1},
      {.start = 11,
       .end = 12,
       .sent = 10,
       .ready = 10,
       .handed = 10,
       .in_epoch = 1,
       .sub_model = 1,
       .released_by = 0,
       .worker = 1,
       .release = Release::task,
       .released_before = true},
  };
  return t;
}

TEST(Profile, TellsWhereTheTimeOfWorkersWent) {
  const Profile p = profile_of(one_heavy());
  EXPECT_DOUBLE_EQ(p.elapsed, 12);
  EXPECT_DOUBLE_EQ(p.all.total(), 24);
  EXPECT_DOUBLE_EQ(p.all.busy, 13);
  EXPECT_DOUBLE_EQ(p.all.imbalance, 9 + 1) << "worker 1 for round 0 of 0, worker 0 for the last task";
  EXPECT_DOUBLE_EQ(p.all.scheduling, 1) << "worker 1 had its task at 10 and began at 11";
  EXPECT_DOUBLE_EQ(p.all.messages, 0);
  EXPECT_DOUBLE_EQ(p.utilisation(), 13.0 / 24);
}

TEST(Profile, NamesWhomOthersWaitedFor) {
  const Profile p = profile_of(one_heavy());
  EXPECT_DOUBLE_EQ(p.sub_models[0].awaited, 9);
  EXPECT_DOUBLE_EQ(p.sub_models[1].awaited, 1);
  EXPECT_EQ(p.most(&SubModelProfile::awaited, 1), std::vector<std::size_t>{0});
  ASSERT_EQ(p.waits.size(), 1U);
  EXPECT_DOUBLE_EQ(p.waits[0].tasks, 10);
}

TEST(Profile, FindsTheCriticalPath) {
  const Trace t = one_heavy();
  const Profile p = profile_of(t);
  EXPECT_DOUBLE_EQ(p.path.tasks, 11);
  EXPECT_DOUBLE_EQ(p.path.scheduling, 1);
  EXPECT_DOUBLE_EQ(p.path.between, 0);
  ASSERT_EQ(p.path.segments.size(), 3U);
  EXPECT_EQ(p.path.segments.front().task, &t.lists.tasks[0]);
  EXPECT_DOUBLE_EQ(p.sub_models[0].on_path, 10);
}

/// Rank 0 works for 4 s and tells rank 1, which has nothing else to do; the message takes 1 s.
Trace two_ranks() {
  Trace t = empty_trace(2, 1, 2);
  t.lists.epochs.push_back({.first_round = 0, .rounds = 1, .epoch = 3});
  t.lists.owners = {{.epoch = 3, .sub_model = 0, .rank = 0}, {.epoch = 3, .sub_model = 1, .rank = 1}};
  t.lists.messages = {{.epoch = 3, .from = 0, .to = 1, .messages = 1, .bytes = 500}};
  t.lists.phases.push_back({.start = 0, .end = 1, .epoch = 3, .rank = 0, .phase = Phase::settle});
  t.lists.phases.push_back({.start = 0, .end = 1, .epoch = 3, .rank = 1, .phase = Phase::settle});
  work(t, 0, 1, 5, 3);
  work(t, 1, 1, 8, 3);
  t.lists.phases.push_back({.start = 5, .end = 8.5, .epoch = 3, .rank = 0, .phase = Phase::agree});
  t.lists.phases.push_back({.start = 8, .end = 8.5, .epoch = 3, .rank = 1, .phase = Phase::agree});
  t.lists.tasks = {{.start = 1, .end = 5, .ready = 1, .handed = 1, .epoch = 3, .sub_model = 0, .rank = 0},
                   {.start = 6,
                    .end = 8,
                    .sent = 5,
                    .ready = 6,
                    .handed = 6,
                    .in_epoch = 1,
                    .epoch = 3,
                    .sub_model = 1,
                    .rank = 1,
                    .release = Release::message,
                    .released_before = true}};
  return t;
}

TEST(Profile, TellsMessagesFromImbalance) {
  const Profile p = profile_of(two_ranks());
  EXPECT_DOUBLE_EQ(p.ranks[1].imbalance, 4) << "for the task of rank 0";
  EXPECT_DOUBLE_EQ(p.ranks[1].messages, 1 + 0.5) << "the message, and agreeing";
  EXPECT_DOUBLE_EQ(p.ranks[0].imbalance, 3) << "for the last of rank 1";
  EXPECT_DOUBLE_EQ(p.all.between, 2);
  EXPECT_DOUBLE_EQ(p.all.total(), 17);
  EXPECT_DOUBLE_EQ(p.path.messages, 1);
  EXPECT_EQ(p.path.hops, 1);
  EXPECT_DOUBLE_EQ(p.path.between, 1.5);
  EXPECT_DOUBLE_EQ(p.communication.messages_between, 1);
  EXPECT_DOUBLE_EQ(p.communication.on_their_way, 1);
  ASSERT_EQ(p.waits.size(), 3U) << "rank 0 waits for its own message as well";
  EXPECT_EQ(p.waits[0].waiter, 1);
  EXPECT_DOUBLE_EQ(p.waits[0].tasks, 4);
  EXPECT_DOUBLE_EQ(p.waits[0].messages, 1);
}

/// A barrier: what was ready at 1 is handed out when the slowest of its rank has ended.
TEST(Profile, BlamesWhoeverHeldTheScheduler) {
  Trace t = empty_trace(1, 2, 2);
  t.lists.epochs.push_back({.first_round = 0, .rounds = 1, .epoch = 0});
  work(t, 0, 0, 6);
  t.lists.tasks = {{.start = 0, .end = 5, .sub_model = 0, .worker = 0},
                   {.start = 0, .end = 1, .sub_model = 1, .worker = 1},
                   {.start = 5,
                    .end = 6,
                    .sent = 1,
                    .ready = 1,
                    .handed = 5,
                    .in_epoch = 1,
                    .sub_model = 1,
                    .released_by = 1,
                    .worker = 1,
                    .release = Release::task,
                    .released_before = true}};
  const Profile p = profile_of(t);
  EXPECT_DOUBLE_EQ(p.all.scheduling, 4);
  EXPECT_DOUBLE_EQ(p.sub_models[0].awaited, 4);
  EXPECT_DOUBLE_EQ(p.path.tasks, 6);
}

/// The clock of rank 1 is ahead by more than tasks take: what released a task was over before it, whatever clocks say.
TEST(Profile, FollowsChainsThroughClocksThatDisagree) {
  constexpr double ahead = 3;
  Trace t = empty_trace(2, 1, 2);
  t.lists.epochs.push_back({.first_round = 0, .rounds = 3, .epoch = 0});
  work(t, 0, 0, 4);
  work(t, 1, ahead, 4 + ahead);
  for (int round = 0; round < 4; ++round) {  // each second another rank's task, released by that of the round before
    const int rank = round % 2;
    const double start = round + rank * ahead;
    TaskRecord& task = t.lists.tasks.emplace_back();
    task = {.start = start, .end = start + 1, .sent = start, .ready = start, .handed = start, .in_epoch = round};
    task.rank = rank;
    task.sub_model = static_cast<std::uint32_t>(rank);
    if (round == 0) continue;
    task.sent = round + (1 - rank) * ahead;
    task.released_by = static_cast<std::uint32_t>(1 - rank);
    task.release = Release::message;
    task.released_before = true;
  }
  sort(t.lists);
  const Profile p = profile_of(t);
  ASSERT_FALSE(p.path.segments.empty());
  EXPECT_EQ(p.path.segments.front().task->in_epoch, 0);
  EXPECT_DOUBLE_EQ(p.path.scheduling, 0);
  EXPECT_DOUBLE_EQ(p.path.tasks + p.path.messages, 7) << "from the first start to the last end";
}

/// A file may say anything: tasks that release each other.
TEST(Profile, EndsChainsThatGoRound) {
  Trace t = empty_trace(2, 1, 2);
  t.lists.epochs.push_back({.first_round = 0, .rounds = 1, .epoch = 0});
  work(t, 0, 0, 9);
  for (const int rank : {0, 1}) {
    TaskRecord& task = t.lists.tasks.emplace_back();
    task = {.start = 7, .end = 8, .sent = 7, .ready = 7, .handed = 7, .in_epoch = 1};
    task.rank = rank;
    task.sub_model = static_cast<std::uint32_t>(rank);
    task.released_by = static_cast<std::uint32_t>(1 - rank);
    task.release = Release::message;
  }
  const Profile p = profile_of(t);
  EXPECT_DOUBLE_EQ(p.path.tasks, 1);
  EXPECT_DOUBLE_EQ(p.path.scheduling, 7);
}

TEST(Profile, MeasuresWhatBalancingGained) {
  Trace t = empty_trace(2, 1, 2);
  t.settings.balancer = "refine";
  double now = 0;
  for (std::uint32_t e = 0; e < 3; ++e, now += 10) {
    t.lists.epochs.push_back({.first_round = e, .rounds = 1, .epoch = e});
    const double first = e == 0 ? 8 : 5;
    t.lists.tasks.push_back({.start = now, .end = now + first, .epoch = e, .sub_model = 0, .rank = 0});
    t.lists.tasks.push_back({.start = now, .end = now + 10 - first, .epoch = e, .sub_model = 1, .rank = 1});
    for (const int rank : {0, 1}) work(t, rank, now, now + first, e);
  }
  t.lists.balance.push_back({.epoch = 1, .carried_out = 1, .gain_seconds = 4, .moves = 1});
  sort(t.lists);
  const Profile p = profile_of(t);
  EXPECT_EQ(p.balance.carried_out, 1);
  EXPECT_DOUBLE_EQ(p.balance.gain, 2 * 3) << "two epochs of 5 s where 8 s would have been";
  EXPECT_DOUBLE_EQ(p.balance.forecast_gain, 4);
}

TEST(Profile, RefusesTracesWithoutTasks) { EXPECT_THROW(profile_of(empty_trace(1, 1, 1)), TraceError); }

TEST(Culprit, IsNamedIfItStandsOut) {
  const std::vector<double> seconds{10, 1, 1, 1}, awaited{6, 1, 1, 0}, even{1, 1, 1, 1.2};
  const auto traced = culprit_of(seconds, awaited);
  ASSERT_TRUE(traced);
  EXPECT_EQ(traced->sub_model, 0U);
  EXPECT_DOUBLE_EQ(traced->share, 0.75);
  EXPECT_DOUBLE_EQ(traced->times_median, 10);
  EXPECT_TRUE(culprit_of(seconds, {}));
  EXPECT_FALSE(culprit_of(even, {}));
  EXPECT_FALSE(culprit_of(even, even));
}

TEST(Sentence, SumsUp) {
  const Account a{.busy = 80, .imbalance = 8, .messages = 2, .scheduling = 1, .between = 9};
  EXPECT_EQ(
      sentence(a, Culprit{3, 0.75, 10, true}, Advice{"--balancer refine", 0.074, false}),
      "11.0 % of the run time was spent waiting: 8.0 % imbalance (75 % of it for sub-model 3, which costs 10.0 times "
      "the median), 2.0 % messages, 1.0 % scheduling; 9.0 % passed between epochs; the cure most likely to help is "
      "--balancer refine: 7.4 % less time.");
  EXPECT_NE(sentence(a, {}, {}).find("no change that was tried"), std::string::npos);
}

}  // namespace
}  // namespace moraine::runtime
