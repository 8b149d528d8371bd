// SPDX-License-Identifier: Apache-2.0
// A traced run: every task once, in an order that can be, in both forms, and the same results.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "runtime/simulation.hpp"
#include "runtime/trace/chrome.hpp"
#include "runtime/trace/task_index.hpp"
#include "tests/support/gossip_model.hpp"
#include "tests/support/rank_run.hpp"

namespace moraine::runtime {
namespace {

using test::RandomGossip;

class Traced : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }

  std::vector<std::uint64_t> run(const TraceOptions& trace) {
    std::vector<std::uint64_t> memories(7);
    moraine::test::on_ranks({.ranks = 3, .shuffled = true}, [&](Transport& transport) {
      RandomGossip model(3, memories.size());
      Options options{.threads = 2, .transport = &transport, .trace = trace};
      options.balance.balancer = "rotate";
      Simulation(model, options).run(0, 60);
      for (SubModelId id = 0; id < model.size(); ++id)
        if (model.placement().holds(id)) memories[id] = model.sub_model(id).memory;
    });
    return memories;
  }
  TraceOptions to(const std::string& name) {
    file_ = std::filesystem::temp_directory_path() / ("moraine_traced_" + name);
    return {.file = file_, .title = "gossip"};
  }

  std::filesystem::path file_;
};

TEST_F(Traced, ChangesNothing) { EXPECT_EQ(run(to("same")), run({})); }

TEST_F(Traced, HasEveryTaskOnceAndItsReleaserBefore) {
  run(to("all"));
  const Trace trace = read_trace(file_);
  ASSERT_TRUE(trace.complete);
  std::size_t expected = 0, messages = 0;
  for (const EpochRecord& e : trace.lists.epochs)
    expected += static_cast<std::size_t>(e.rounds + 1) * 7 * trace.settings.stages.size();
  EXPECT_EQ(trace.lists.tasks.size(), expected);
  const TaskIndex index(trace.lists.tasks);
  for (const TaskRecord& t : trace.lists.tasks) {
    EXPECT_EQ(index.find(t.epoch, t.in_epoch, t.sub_model, t.stage), &t) << "each once";
    EXPECT_LE(t.ready, t.handed);
    EXPECT_LE(t.handed, t.start);
    if (t.release == Release::start) continue;
    const TaskRecord* by = index.releasing(t);
    ASSERT_NE(by, nullptr);
    EXPECT_EQ(by->rank != t.rank, t.release == Release::message);
    if (t.release == Release::task) {
      EXPECT_LE(by->end, t.start);
    }
    messages += t.release == Release::message;
  }
  EXPECT_GT(messages, 0U);
  EXPECT_FALSE(trace.lists.moves.empty());
  EXPECT_EQ(trace.settings.ranks(), 3);
}

TEST_F(Traced, IsTheSameInJson) {
  run(to("binary"));
  const Trace trace = read_trace(file_);
  const std::filesystem::path json = file_.string() + ".json";
  write_chrome(trace, json);
  const Trace again = read_trace(json);
  std::filesystem::remove(json);
  ASSERT_EQ(again.lists.tasks.size(), trace.lists.tasks.size());
  for (std::size_t i = 0; i < trace.lists.tasks.size(); ++i) {
    const TaskRecord &a = trace.lists.tasks[i], &b = again.lists.tasks[i];
    EXPECT_NEAR(a.start, b.start, 2e-9);
    EXPECT_NEAR(a.end, b.end, 3e-9);
    EXPECT_EQ(a.sub_model, b.sub_model);
    EXPECT_EQ(a.released_by, b.released_by);
    EXPECT_EQ(a.bytes_received, b.bytes_received);
  }
  EXPECT_EQ(again.lists.phases.size(), trace.lists.phases.size());
  EXPECT_EQ(again.lists.messages.size(), trace.lists.messages.size());
  EXPECT_EQ(again.settings.stages, trace.settings.stages);
}

TEST_F(Traced, KeepsToItsWindow) {
  TraceOptions options = to("window");
  options.from = 20;
  options.to = 30;
  run(options);
  const Trace trace = read_trace(file_);
  ASSERT_FALSE(trace.lists.epochs.empty());
  for (const EpochRecord& e : trace.lists.epochs) {
    EXPECT_LT(e.first_round, 30);
    EXPECT_GT(e.first_round + e.rounds, 20);
  }
}

}  // namespace
}  // namespace moraine::runtime
