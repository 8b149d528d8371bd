// SPDX-License-Identifier: Apache-2.0
// A traced run: every task once, in an order that can be, in both forms, and the same results.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "runtime/profile/profile.hpp"
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
  void TearDown() override {
    std::filesystem::remove(file_);
    std::filesystem::remove(part());
  }

  std::vector<std::uint64_t> run(const TraceOptions& trace, const std::function<void(RandomGossip&)>& prepare = {}) {
    std::vector<std::uint64_t> memories(7);
    moraine::test::on_ranks({.ranks = 3, .shuffled = true}, [&](Transport& transport) {
      RandomGossip model(3, memories.size());
      if (prepare) prepare(model);
      Options options{.threads = 2, .transport = &transport, .trace = trace};
      options.balance.balancer = "rotate";
      Simulation(model, options).run(0, 60);
      for (SubModelId id = 0; id < model.size(); ++id)
        if (model.placement().holds(id)) memories[id] = model.sub_model(id).memory;
    });
    return memories;
  }
  TraceOptions to(const std::string& name) {
    file_ = std::filesystem::temp_directory_path() / ("moraine_traced_" + std::to_string(getpid()) + "_" + name);
    return {.file = file_, .title = "gossip"};
  }
  /// The compact form, while there is no JSON.
  std::filesystem::path part() const { return std::filesystem::path(file_).replace_extension(".part"); }

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

TEST_F(Traced, JsonOfAFailedRunHoldsWhatWasWritten) {
  const auto fail_late = [](RandomGossip& model) {
    model.sub_model(5).on_task = [](int, const Round& round) {
      if (round.number >= 40) throw std::runtime_error("no more");
    };
  };
  EXPECT_THROW(run(to("failed.json"), fail_late), RunError);
  const Trace trace = read_trace(file_);
  EXPECT_FALSE(trace.complete);
  ASSERT_FALSE(trace.lists.epochs.empty());
  EXPECT_LE(trace.lists.epochs.back().first_round, 40);
  EXPECT_EQ(profile_of(trace).sub_models.size(), 7U);
  EXPECT_FALSE(std::filesystem::exists(part()));
}

TEST_F(Traced, KeepsTheCompactFormIfTheDiskIsFull) {
  TraceOptions options = to("full.json");
  std::filesystem::remove(file_);
  std::filesystem::create_symlink("/dev/full", file_);
  RandomGossip model(3, 7);
  EXPECT_THROW(Simulation(model, {.threads = 2, .trace = options}).run(0, 20), std::runtime_error);
  const Trace trace = read_trace(part());
  EXPECT_TRUE(trace.complete);
  EXPECT_FALSE(trace.lists.tasks.empty());
}

/// What viewers need: complete events with a time and a length that do not overlap in their row, and of every arrow one
/// beginning and one end.
TEST_F(Traced, JsonIsWellFormedForViewers) {
  run(to("viewers"));
  const Trace trace = read_trace(file_);
  const std::filesystem::path file = file_.string() + ".json";
  write_chrome(trace, file);
  const auto json = nlohmann::json::parse(std::ifstream(file));
  std::filesystem::remove(file);
  std::map<std::size_t, std::pair<int, int>> arrows;  // beginnings and ends by id
  std::map<std::pair<int, int>, double> until;        // by process and thread
  std::size_t tasks = 0;
  for (const auto& e : json.at("traceEvents")) {
    const std::string kind = e.at("ph");
    if (kind == "s") ++arrows[e.at("id")].first;
    if (kind == "f") ++arrows[e.at("id")].second;
    if (kind != "X") continue;
    double& end = until.try_emplace({e.at("pid"), e.at("tid")}, -1e12).first->second;
    EXPECT_GE(e.at("ts").get<double>(), end - 0.002);
    EXPECT_GE(e.at("dur").get<double>(), 0);
    end = e.at("ts").get<double>() + e.at("dur").get<double>();
    tasks += e.at("cat") == "task";
  }
  EXPECT_EQ(tasks, trace.lists.tasks.size());
  std::size_t released = 0;
  for (const TaskRecord& t : trace.lists.tasks) released += t.release != Release::start;
  EXPECT_EQ(arrows.size(), released);
  for (const auto& [id, ends] : arrows) EXPECT_EQ(ends, std::pair(1, 1)) << id;
}

/// The chain back from the last task of each epoch covers it without gaps, and no worker's time gets lost.
TEST_F(Traced, ProfilesAddUp) {
  run(to("profile"));
  const Trace trace = read_trace(file_);
  const Profile p = profile_of(trace);
  for (std::size_t i = 1; i < p.path.segments.size(); ++i) {
    const Segment &a = p.path.segments[i - 1], &b = p.path.segments[i];
    if (a.task->epoch == b.task->epoch) {
      EXPECT_DOUBLE_EQ(a.end, b.start);
    }
    EXPECT_GT(b.end, b.start);
  }
  double spans = 0;
  for (const EpochLoad& e : p.epochs) spans += e.end - e.start;
  const double path = p.path.tasks + p.path.messages + p.path.scheduling;
  EXPECT_GE(path, spans - 1e-9);
  EXPECT_LE(path, p.elapsed + 1e-9);
  EXPECT_EQ(p.path.segments.front().task->in_epoch, 0);
  for (std::size_t rank = 0; rank < p.ranks.size(); ++rank) {
    double phases = 0;
    for (const PhaseRecord& r : trace.lists.phases) phases += r.rank == static_cast<int>(rank) ? r.seconds() : 0;
    EXPECT_NEAR(p.ranks[rank].total(), 2 * phases, 0.02 * phases) << "two workers";
  }
  double seconds = 0;
  for (const SubModelProfile& s : p.sub_models) seconds += s.seconds;
  EXPECT_NEAR(seconds, p.all.busy, 1e-9);
  EXPECT_GT(p.balance.carried_out, 0);
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
