// SPDX-License-Identifier: Apache-2.0
// The command under mpirun: the same answer, one error for all, going on after a kill.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/shell.hpp"

namespace moraine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::Ended;
using test::shell;

class Mpi : public testing::Test {
 protected:
  void SetUp() override {
    out_ = fs::temp_directory_path() / ("moraine_mpi_" + std::to_string(getpid()) + "_" +
                                        testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(out_);
  }
  void TearDown() override { fs::remove_all(out_); }

  /// The shell's words for running dam on some ranks, as mpirun() has it.
  std::string line(int ranks, const std::string& options) const {
    return test::mpirun(ranks) + MORAINE_COMMAND + " run " +
           MORAINE_SOURCE_DIR
           "/apps/scenes/dam.yaml --set count=600 --sub-models 7 --threads 1 --quiet --set "
           "output.pictures=false --out " +
           out_.string() + " " + options;
  }
  Ended run(int ranks, const std::string& options) const { return shell(line(ranks, options)); }
  Json summary() const { return Json::parse(std::ifstream(out_ / "summary.json")); }
  std::string hash(int ranks, const std::string& options) const {
    const Ended ended = run(ranks, options);
    EXPECT_EQ(ended.status, 0) << ended.text;
    return summary().at("state_hash");
  }

  fs::path out_;
};

TEST_F(Mpi, GivesTheAnswerOfOneProcess) {
  const std::string alone = hash(0, "--steps 200");
  EXPECT_EQ(summary().at("ranks"), 1);
  EXPECT_EQ(hash(2, "--steps 200 --balancer rotate --output-every 30"), alone);
  EXPECT_EQ(summary().at("ranks"), 2);
  EXPECT_GT(summary().at("load").at("migrations"), 7);
  EXPECT_EQ(hash(3, "--steps 200 --balancer graph"), alone);
}

TEST_F(Mpi, AnErrorIsSaidOnceAndEndsAllRanks) {
  const Ended ended = run(3, "--steps 200 --set run.max_speed=2");
  EXPECT_EQ(ended.status, 3) << ended.text;
  const std::size_t first = ended.text.find("runs away at step");
  EXPECT_NE(first, std::string::npos) << ended.text;
  EXPECT_EQ(ended.text.find("runs away at step", first + 1), std::string::npos) << ended.text;
  EXPECT_NE(ended.text.find("bound_update of sub-model"), std::string::npos) << ended.text;
}

/// Sub-model 6 fails while the other rank's results, too long to be sent before they are asked for, are on their way.
TEST_F(Mpi, AnErrorEndsRanksThatStillSend) {
  fs::create_directories(out_);
  std::ofstream(out_ / "scene.yaml") << R"(
gravity: [0, 0, -9.81]
materials: {grain: {density: 1000, friction: 0.5}}
elements:
  - {packing: cubic, shape: {sphere: 0.5}, cells: [70, 24, 24], material: grain, at: [0, 0, 0]}
  - {packing: list, shape: {sphere: 0.5}, material: grain, items: [{at: [68, 12, 60]}]}
boundaries: [{plane: {normal: [0, 0, 1]}, material: grain}]
time: {dt: 1 / 100, steps: 200}
run: {engine: impulse, sub_models: 7, split: slabs, owners: [2, 5], threads: 1}
output: {pictures: false, every: 0}
)";
  for (const char* limit : {"1", "2", "3"}) {
    const Ended ended =
        shell("timeout -k 1 90 " + test::mpirun(2, "--mca btl_vader_eager_limit 128 ") + MORAINE_COMMAND + " run " +
              out_.string() + "/scene.yaml --quiet --out " + out_.string() + " --set run.max_speed=" + limit);
    EXPECT_EQ(ended.status, 3) << ended.text;
  }
}

TEST_F(Mpi, WrongInputEndsAllRanks) {
  const Ended ended = run(3, "--set nonsense.key=1");
  EXPECT_EQ(ended.status, 2) << ended.text;
}

TEST_F(Mpi, RefusesRanksThatWouldRunSomethingElse) {
  const std::string own = "sh -c 'test $OMPI_COMM_WORLD_RANK = 0 || export MORAINE_";
  const auto refused = [&](const std::string& variable, const std::string& part) {
    const std::string command = "timeout -k 1 60 " + test::mpirun(2) + own + variable +
                                "; exec " MORAINE_COMMAND " run " +
                                MORAINE_SOURCE_DIR "/apps/scenes/dam.yaml --set count=100 --out " + out_.string() + "'";
    const Ended ended = shell(command);
    EXPECT_EQ(ended.status, 2) << ended.text;
    EXPECT_NE(ended.text.find("rank 1 has " + part), std::string::npos) << ended.text;
  };
  refused("ITERATIONS=3", "a scene of identity");
  refused("STEPS=7", "7 steps of 1 substeps, rank 0 ");
  refused("THREADS=1", "threads stated, rank 0 threads not stated");
}

TEST_F(Mpi, RefusesOwnersThatDoNotAddUp) {
  const Ended ended = run(2, "--set run.owners=[3,3]");
  EXPECT_EQ(ended.status, 2) << ended.text;
  EXPECT_NE(ended.text.find("6 sub-models on 2 ranks, expected 7 on 2"), std::string::npos) << ended.text;
}

/// Frames written before a stop stay, in the index and in files that hold all of them.
TEST_F(Mpi, KeepsFramesOverARestart) {
  const std::string output = " --output-every 30 --set output.formats=[pvd,lammps_dump,vtkhdf]";
  const auto dump = [&] {
    std::ifstream file(out_ / "dump.lammpstrj");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(run(0, "--steps 200" + output).status, 0);
  const std::string whole = dump();
  fs::remove_all(out_);
  EXPECT_EQ(run(0, "--steps 120 --checkpoint-every 10" + output).status, 0);
  EXPECT_EQ(run(2, "--steps 200 --checkpoint-every 10 --restart latest" + output).status, 0);
  EXPECT_TRUE(dump() == whole);
  std::ifstream index(out_ / "elements.pvd");
  int frames = 0;
  for (std::string line; std::getline(index, line);) frames += line.starts_with("<DataSet") ? 1 : 0;
  EXPECT_EQ(frames, 8) << "steps 0, 30, 60, 90, 120, 150, 180, 200";
}

/// Its speed is that of its own steps; the newest checkpoint is of the second half.
TEST_F(Mpi, CountsItsOwnStepsAfterARestart) {
  EXPECT_EQ(run(0, "--steps 200 --checkpoint-every 10").status, 0);
  EXPECT_EQ(run(0, "--steps 220 --restart latest").status, 0);
  const Json all = summary();
  const double done = all.at("element_steps_per_s").get<double>() * all.at("loop_wall_s").get<double>();
  const double whole = all.at("elements").get<double>() * 220;
  EXPECT_GE(done, 0.999 * whole * 20 / 220);
  EXPECT_LE(done, whole / 2);
}

/// A checkpoint of other materials is of another run. 200 steps see several epochs, of which the longest has 64 rounds;
/// the first checkpoint is made after the first of them.
TEST_F(Mpi, RefusesACheckpointOfAnotherStiffness) {
  const std::string soft =
      "--steps 200 --set count=100 --engine soft_sphere --dt 3e-4 --set materials.grain.restitution=0.5 ";
  EXPECT_EQ(run(0, soft + "--checkpoint-every 10").status, 0);
  const Ended other = run(0, soft + "--restart latest --set materials.grain.normal_stiffness=1e4");
  EXPECT_EQ(other.status, 2) << other.text;
  EXPECT_NE(other.text.find("of another run"), std::string::npos) << other.text;
}

/// One rank is killed in the middle; the others end, and the run goes on from its last checkpoint on other ranks.
TEST_F(Mpi, GoesOnAfterAKill) {
  const std::string steps = "--steps 1500 --checkpoint-every 20 ";
  const std::string whole = hash(0, steps);
  fs::remove_all(out_);
  const std::string saved = "ls " + out_.string() + "/checkpoints/*/manifest.json > /dev/null 2>&1";
  const Ended killed =
      shell(line(2, steps) + " & while kill -0 $! && ! " + saved + "; do sleep 0.05; done; pkill -9 -n -P $!; wait $!");
  EXPECT_NE(killed.status, 0);
  EXPECT_NE(killed.text.find("--restart latest"), std::string::npos) << killed.text;
  EXPECT_EQ(hash(3, steps + "--restart latest"), whole);
}

}  // namespace
}  // namespace moraine
