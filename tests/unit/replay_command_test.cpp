// SPDX-License-Identifier: Apache-2.0
// moraine replay: options, texts, exit status.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runtime/trace/trace_file.hpp"
#include "tests/support/shell.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine {
namespace {

using test::Ended;
using test::shell;

/// Three sub-models that know nothing of each other, ten rounds of a second each, on one thread.
runtime::Trace three_sub_models() {
  runtime::Trace t;
  t.settings.scheduler = "serial";
  t.settings.balancer = "none";
  t.settings.predictor = "median";
  t.settings.sub_models = 3;
  t.settings.threads = {1};
  t.settings.cores = {1};
  t.settings.stages = {"move"};
  t.settings.receives = {-1};
  t.lists.epochs.push_back({.first_round = 0, .rounds = 9, .epoch = 0});
  double now = 0;
  for (std::int32_t round = 0; round < 10; ++round)
    for (std::uint32_t s = 0; s < 3; ++s, ++now)
      t.lists.tasks.push_back({.start = now, .end = now + 1, .handed = now, .in_epoch = round, .sub_model = s});
  t.lists.phases.push_back({.start = 0, .end = now, .phase = runtime::Phase::work});
  return t;
}

class ReplayCommand : public testing::Test {
 protected:
  void SetUp() override {
    const runtime::Trace t = three_sub_models();
    runtime::TraceWriter writer(file_, t.settings);
    writer.append(runtime::pack(t.lists));
    writer.finish();
  }
  Ended replay(const std::string& options) const { return shell("moraine replay " + file_.string() + " " + options); }

  Folder folder_;
  std::filesystem::path file_ = folder_.write("three.trace", "");
};

TEST_F(ReplayCommand, PredictsAsTraced) {
  const Ended e = replay("--json");
  ASSERT_EQ(e.status, 0) << e.text;
  const auto json = nlohmann::json::parse(e.text);
  EXPECT_DOUBLE_EQ(json["best"]["makespan_s"], 30);
  EXPECT_DOUBLE_EQ(json["best"]["traced_makespan_s"], 30);
  EXPECT_DOUBLE_EQ(json["best"]["utilisation"], 1);
}

TEST_F(ReplayCommand, SweepsAndNamesTheBest) {
  const Ended e = replay("--scheduler barrier,hybrid --threads 1,2,3 --ranks 1");
  ASSERT_EQ(e.status, 0) << e.text;
  EXPECT_NE(e.text.find("75.0"), std::string::npos) << e.text;
  EXPECT_NE(e.text.find("best: 1 x 3, barrier, none, 10.0000 s"), std::string::npos) << e.text;
}

TEST_F(ReplayCommand, ScalesTheModel) {
  const Ended e = replay("--scale 5 --ranks 5 --threads 3 --scheduler hybrid --json");
  ASSERT_EQ(e.status, 0) << e.text;
  const auto json = nlohmann::json::parse(e.text);
  EXPECT_EQ(json["best"]["sub_models"], 15);
  EXPECT_DOUBLE_EQ(json["best"]["tasks_span_s"], 10);
}

TEST_F(ReplayCommand, RefusesWhatItDoesNotKnow) {
  for (const char* wrong : {"--scheduler fastest", "--balancer best", "--ranks 0", "--ranks two", "--scale 0"}) {
    const Ended e = replay(wrong);
    EXPECT_EQ(e.status, 2) << wrong << ": " << e.text;
  }
  const Ended none = shell("moraine replay " + (file_.parent_path() / "none.trace").string());
  EXPECT_EQ(none.status, 2) << none.text;
  EXPECT_NE(none.text.find("none.trace"), std::string::npos) << none.text;
}

}  // namespace
}  // namespace moraine
