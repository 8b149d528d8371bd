// SPDX-License-Identifier: Apache-2.0
// Stopping and going on from a checkpoint changes nothing; a bad checkpoint is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/model_run.hpp"
#include "tests/support/rank_run.hpp"

namespace moraine {
namespace {

namespace fs = std::filesystem;
using test::example;
using test::set;

class Checkpoint : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("moraine_checkpoint_{}_{}", getpid(),
                                                      testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  runtime::Options options(runtime::Transport& transport, const std::string& of_run = "dam") const {
    runtime::Options o;
    o.threads = 1;
    o.transport = &transport;
    o.balance.balancer = "rotate";
    o.checkpoint = {folder_, 10, of_run, 2};
    return o;
  }

  /// Runs until `end`, from the newest checkpoint if `restart`. Returns the hash.
  std::uint64_t run(int ranks, std::int64_t end, bool restart, const std::string& of_run = "dam") const {
    std::uint64_t hash = 0;
    test::on_ranks({.ranks = ranks}, [&](runtime::Transport& transport) {
      CoupledModel model(scene_, transport);
      runtime::Simulation simulation(model, options(transport, of_run));
      const std::int64_t first = restart ? simulation.restore(newest()) : 0;
      simulation.run(first, end - first);
      const auto states = model.states(0);
      if (transport.rank() == 0) hash = state_hash(scene_, states);
    });
    return hash;
  }

  fs::path newest() const { return runtime::list_checkpoints(folder_).at(0); }

  void restore(const std::string& of_run = "dam") const {
    CoupledModel model(scene_);
    runtime::Simulation(model, options(runtime::alone(), of_run)).restore(newest());
  }

  std::string refusal(const std::string& of_run = "dam") const {
    try {
      restore(of_run);
    } catch (const runtime::CheckpointError& e) {
      return e.what();
    }
    return "none";
  }

  const Scene scene_ = example("dam", {set("count", 400), set("time.steps", 300), set("run.sub_models", 5)});
  fs::path folder_;
};

TEST_F(Checkpoint, GoesOnOnOtherRanksAsIfItHadNeverStopped) {
  const std::uint64_t whole = run(1, 300, false);
  fs::remove_all(folder_);
  run(2, 110, false);
  EXPECT_EQ(run(3, 210, true), run(1, 210, true)) << "twice from the same";
  EXPECT_EQ(run(1, 300, true), whole);
}

TEST_F(Checkpoint, KeepsTheLastTwo) {
  run(1, 300, false);
  EXPECT_EQ(runtime::list_checkpoints(folder_).size(), 2U);
}

/// Whether they are of later rounds or of the same.
TEST_F(Checkpoint, StaysIfOfAnotherRun) {
  run(1, 300, false, "heap");
  const std::vector<fs::path> others = runtime::list_checkpoints(folder_, "heap");
  ASSERT_EQ(others.size(), 2U);
  for (const std::int64_t end : {110, 300}) {
    run(1, end, false);
    EXPECT_FALSE(runtime::list_checkpoints(folder_, "dam").empty()) << end;
    EXPECT_TRUE(runtime::list_checkpoints(folder_, "heap") == others) << end;
  }
  EXPECT_EQ(runtime::list_checkpoints(folder_).size(), 4U);
}

TEST_F(Checkpoint, IsSetAsideByTheSameRunBegunAnew) {
  const std::uint64_t whole = run(1, 300, false);
  const std::string last = newest().filename().string();
  run(1, 110, false);
  EXPECT_LT(newest().filename().string(), last);
  const fs::path aside = folder_ / ("earlier_" + last.substr(std::string("round_").size()));
  EXPECT_TRUE(fs::exists(aside / "manifest.json")) << aside.string();
  EXPECT_EQ(run(1, 300, true), whole);
}

TEST_F(Checkpoint, IsRefusedIfDamagedAndTheOneBeforeIsOffered) {
  run(1, 300, false);
  const fs::path victim = newest() / "sub_model_000003.bin";
  {
    std::fstream file(victim, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(100);
    file.put('\x5A');
    file.seekp(101);
    file.put('\x5B');
  }
  const std::string why = refusal();
  EXPECT_NE(why.find("sub_model_000003.bin: damaged"), std::string::npos) << why;
  EXPECT_NE(why.find(runtime::list_checkpoints(folder_).at(1).string()), std::string::npos) << why;
}

TEST_F(Checkpoint, IsRefusedIfTruncatedForeignOrIncomplete) {
  run(1, 300, false);
  EXPECT_NE(refusal("heap").find("of another run"), std::string::npos);
  fs::resize_file(newest() / "common.bin", 40);
  EXPECT_NE(refusal().find("truncated"), std::string::npos) << refusal();
  std::ofstream(newest() / "manifest.json") << "{";
  EXPECT_NE(refusal().find("no complete checkpoint"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace moraine
