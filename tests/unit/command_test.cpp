// SPDX-License-Identifier: Apache-2.0
// The command itself: exit status, texts, options, what it leaves behind.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runtime/trace/chrome.hpp"
#include "tests/support/shell.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine {
namespace {

using Json = nlohmann::json;

using test::Ended;
using test::shell;

const std::string good = R"(
name: two balls
parameters: {height: 1}
materials: {rock: {density: 1000, restitution: 0.5}}
elements:
  - {packing: list, shape: {sphere: 0.5}, items: [{id: 1, at: [0, 0, height]}, {id: 2, at: [0.1, 0, 2.2]}]}
boundaries: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}}]
time: {dt: 0.01, steps: 5}
output: {pictures: false}
)";

class Command : public testing::Test {
 protected:
  std::string out() const { return (root_ / "out").string(); }
  std::string write(const std::string& text) { return folder_.write("scene.yaml", text).string(); }
  Ended run(const std::string& text, const std::string& options = "", const std::string& environment = "") {
    return shell(environment + (environment.empty() ? "" : "; ") + "moraine run " + write(text) + " --out " + out() +
                 " " + options);
  }
  Json summary() const { return Json::parse(std::ifstream(out() + "/summary.json")); }

  Folder folder_;
  std::filesystem::path root_ = folder_.write("empty", "").parent_path();
};

void expect_input_error(const Ended& ended, const std::string& part) {
  EXPECT_EQ(ended.status, 2) << ended.text;
  EXPECT_NE(ended.text.find(part), std::string::npos) << ended.text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(Command, RunsAScene) {
  const Ended ended = run(good);
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_NE(ended.text.find("two balls"), std::string::npos);
  EXPECT_EQ(summary().at("elements"), 2);
}

TEST_F(Command, PredictsLoadsAsTold) {
  const std::string trace = out() + ".trace";
  const Ended ended = run(good, "--load-prediction trend --trace " + trace);
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_EQ(runtime::read_trace(trace).settings.predictor, "trend");
  expect_input_error(run(good, "--load-prediction fortune"), "no load predictor is called 'fortune'");
}

TEST_F(Command, WithoutAnythingIsBadUsage) {
  for (const char* line : {"moraine", "moraine jump", "moraine run", "moraine run a.yaml --fast", "moraine render"})
    EXPECT_EQ(shell(line).status, 2) << line;
}

TEST_F(Command, HelpAndVersionAreNoErrors) {
  for (const char* line : {"moraine --help", "moraine run --help", "moraine --version", "moraine list"}) {
    const Ended ended = shell(line);
    EXPECT_EQ(ended.status, 0) << line;
    EXPECT_FALSE(ended.text.empty()) << line;
  }
}

TEST_F(Command, ListNamesEveryTable) {
  const std::string text = shell("moraine list").text;
  for (const char* name : {"bullet", "pillars", "consensus", "hybrid", "diffusion", "pvd"})
    EXPECT_NE(text.find(name), std::string::npos) << name;
}

TEST_F(Command, InfoSaysWhatWouldRunAndWritesNothing) {
  const Ended ended = shell("cd " + root_.string() + "; moraine info " + write(good));
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_NE(ended.text.find("restitution; left out: friction, rotation, bonds, shapes other than spheres"),
            std::string::npos)
      << ended.text;
  EXPECT_FALSE(std::filesystem::exists(root_ / "out"));
}

TEST_F(Command, AutoTakesTheEngineThatTheShapesNeed) {
  EXPECT_EQ(run(good, "--engine auto").status, 0);
  EXPECT_EQ(summary().at("engine"), "impulse");
  EXPECT_EQ(run(replaced(good, "shape: {sphere: 0.5}", "shape: {box: [1, 1, 1]}"), "--engine auto").status, 0);
  EXPECT_EQ(summary().at("engine"), "bullet");
  const Ended info = shell("moraine info " + write(good) + " --engine auto");
  EXPECT_NE(info.text.find("impulse (auto)"), std::string::npos) << info.text;
}

TEST_F(Command, RefusesWrongScenes) {
  expect_input_error(shell("moraine run /nowhere/scene.yaml"), "/nowhere/scene.yaml");
  expect_input_error(run(good + "run: {threds: 2}\n"), "scene.yaml:10:7: unknown key 'threds'");
  expect_input_error(run(replaced(good, "steps: 5", "steps: many")), "scene.yaml:8:25: 'time.steps'");
  expect_input_error(run(replaced(good, "sphere: 0.5", "sphere: -0.5")), "is -0.5, expected more than 0");
  expect_input_error(run(replaced(good, "at: [0, 0, height]", "at: [0, .nan, height]")), "scene.yaml:6:");
  expect_input_error(run(replaced(good, "{id: 1,", "{id: 1, mass: 0,")), "mass' is 0, expected more than 0");
  expect_input_error(run(replaced(good, "id: 2", "id: 1")), "1");
  expect_input_error(run(good + "bonds: [{a: 1, b: 7, stiffness: 1}]\n"), "element 7, which does not exist");
}

TEST_F(Command, RefusesStepsTooLongForTheEngine) {
  expect_input_error(run(good, "--engine soft_sphere"), "a substep of 0.01 s is too long for engine soft_sphere");
  EXPECT_EQ(run(good, "--engine soft_sphere --dt 1e-5").status, 0);
  EXPECT_EQ(summary().at("coupling"), "exact");
}

TEST_F(Command, RefusesUnknownNamesAndListsThoseItKnows) {
  expect_input_error(run(good, "--engine steam"), "bullet");
  expect_input_error(run(good, "--split thirds"), "pillars");
  expect_input_error(run(good, "--coupling glue"), "consensus");
  expect_input_error(run(good, "--engine soft_sphere --dt 1e-5 --coupling mirror"), "exact");
  expect_input_error(run(good, "--coupling exact"), "consensus, mirror");
  const Ended scheduler = run(good, "--scheduler fastest");
  EXPECT_NE(scheduler.status, 0);
  EXPECT_NE(scheduler.text.find("hybrid"), std::string::npos) << scheduler.text;
  expect_input_error(run(good, "--set run.engine_profile=cray"), "physx");
  expect_input_error(run(good, "--set nonsense"), "--set nonsense");
  expect_input_error(run(good, "--threads=-1"), "--threads");
  expect_input_error(run(good, "--set output.formats=[tape]"), "pvd");
}

TEST_F(Command, RefusesMoreThanTheEngineProfileHolds) {
  const std::string many = replaced(
      good, "{packing: list, shape: {sphere: 0.5}, items: [{id: 1, at: [0, 0, height]}, {id: 2, at: [0.1, 0, 2.2]}]}",
      "{packing: cubic, shape: {sphere: 0.5}, cells: [30, 30, 22], at: [0, 0, 1]}");
  expect_input_error(run(many, "--sub-models 1 --set run.engine_profile=physx"), "use at least 2 sub-models");
  expect_input_error(run(good, "--sub-models 65 --set run.engine_profile=physx"), "64 worlds");
}

TEST_F(Command, RefusesAnOutputFolderItCannotMake) {
  const Ended ended = shell("moraine run " + write(good) + " --out /proc/x");
  EXPECT_EQ(ended.status, 2) << ended.text;
  EXPECT_NE(ended.text.find("/proc/x"), std::string::npos) << ended.text;
}

TEST_F(Command, RunsASceneWithoutParametersWithOptions) {
  const Ended ended = run("name: plain\ntime: {dt: 0.01, steps: 5}\n");
  EXPECT_EQ(ended.status, 0) << ended.text;
}

TEST_F(Command, RunsNoElementsAndSaysSo) {
  const Ended ended = run("name: nothing\ntime: {dt: 0.01, steps: 5}\n");
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_NE(ended.text.find("no elements"), std::string::npos) << ended.text;
  const Json s = summary();
  EXPECT_EQ(s.at("elements"), 0);
  EXPECT_EQ(s.at("warnings").size(), 1U);
  EXPECT_EQ(s.at("kinetic_energy"), 0);
  EXPECT_EQ(s.at("steps"), 5);
}

TEST_F(Command, StopsWhenAnElementRunsAway) {
  const Ended ended = run(good, "--steps 50 --set run.max_speed=0.5");
  EXPECT_EQ(ended.status, 3) << ended.text;
  EXPECT_NE(ended.text.find("element 1 "), std::string::npos) << ended.text;
  EXPECT_NE(ended.text.find("step 5"), std::string::npos) << "0.05 s of falling; " << ended.text;
}

TEST_F(Command, SummaryHasAllKeys) {
  ASSERT_EQ(run(good).status, 0);
  const Json s = summary();
  for (const char* key : {"scene",
                          "engine",
                          "precision",
                          "coupling",
                          "split",
                          "scheduler",
                          "balancer",
                          "ranks",
                          "threads_per_rank",
                          "elements",
                          "sub_models",
                          "steps",
                          "substeps",
                          "dt",
                          "wall_s",
                          "loop_wall_s",
                          "element_steps_per_s",
                          "peak_rss_bytes",
                          "state_hash",
                          "ghosts",
                          "bonds",
                          "momentum_residual",
                          "kinetic_energy",
                          "center_of_mass",
                          "overlap",
                          "coupling_residual",
                          "load",
                          "warnings"})
    EXPECT_TRUE(s.contains(key)) << key;
  for (const char* key : {"mean", "max", "final", "fraction_mean", "fraction_final"})
    EXPECT_TRUE(s.at("ghosts").contains(key)) << key;
  for (const char* key : {"total", "broken"}) EXPECT_TRUE(s.at("bonds").contains(key)) << key;
  for (const char* key : {"linear", "angular"}) EXPECT_TRUE(s.at("momentum_residual").contains(key)) << key;
  for (const char* key : {"max", "mean"}) EXPECT_TRUE(s.at("overlap").contains(key)) << key;
  for (const char* key : {"imbalance", "utilisation", "waiting_fraction", "migrations"})
    EXPECT_TRUE(s.at("load").contains(key)) << key;
  EXPECT_EQ(s.at("center_of_mass").size(), 3U);
  EXPECT_EQ(s.at("state_hash").get<std::string>().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(s.at("state_hash").get<std::string>().size(), 16U);
  EXPECT_EQ(s.at("precision"), "float32");
  EXPECT_NE(s.at("split"), "auto") << "what was used";
}

TEST_F(Command, CommandLineWinsOverEnvironmentOverScene) {
  const std::string scene = good + "run: {threads: 1, scheduler: serial}\n";
  ASSERT_EQ(run(scene).status, 0);
  EXPECT_EQ(summary().at("threads_per_rank"), 1);
  ASSERT_EQ(run(scene, "", "export MORAINE_THREADS=2 MORAINE_SCHEDULER=stealing").status, 0);
  EXPECT_EQ(summary().at("threads_per_rank"), 2);
  EXPECT_EQ(summary().at("scheduler"), "stealing");
  ASSERT_EQ(run(scene, "--threads 3", "export MORAINE_THREADS=2 MORAINE_SCHEDULER=stealing").status, 0);
  EXPECT_EQ(summary().at("threads_per_rank"), 3);
  EXPECT_EQ(summary().at("scheduler"), "stealing");
}

TEST_F(Command, WrongEnvironmentIsNamed) {
  expect_input_error(run(good, "", "export MORAINE_THREADS=lots"), "MORAINE_THREADS");
}

TEST_F(Command, RefusesOptionsWithoutAValue) {
  for (const char* flag : {"--restart", "--threads", "--steps", "--trace", "--engine"})
    expect_input_error(run(good, std::string(flag) + " ''"), std::string(flag) + ": is empty");
  expect_input_error(run(good, "", "export MORAINE_RESTART="), "MORAINE_RESTART run.restart: 'run.restart' is empty");
}

/// The checkpoint is of step 10 or later.
TEST_F(Command, RefusesToGoOnFromBeyondTheEnd) {
  ASSERT_EQ(run(good, "--steps 200 --sub-models 2 --checkpoint-every 10").status, 0);
  expect_input_error(run(good, "--steps 5 --sub-models 2 --restart latest"),
                     "expected at most the 5 steps of this run");
  EXPECT_EQ(summary().at("steps"), 200) << "nothing is written over";
}

TEST_F(Command, GoesOnFromTheLatestCheckpointOfItsOwn) {
  const std::string options = "--sub-models 2 --checkpoint-every 10 ";
  ASSERT_EQ(run(good, options + "--steps 200").status, 0);
  const std::string whole = summary().at("state_hash");
  std::filesystem::remove_all(out());
  ASSERT_EQ(run(good, options + "--steps 300 --set height=1.1").status, 0);
  ASSERT_EQ(run(good, options + "--steps 100").status, 0);
  const Ended ended = run(good, options + "--steps 200 --restart latest");
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_EQ(summary().at("state_hash"), whole);
  expect_input_error(run(good, options + "--steps 400 --restart latest --set height=1.05"), "of another run");
}

TEST_F(Command, ThreadsAndSchedulersDoNotChangeTheHash) {
  ASSERT_EQ(run(good, "--steps 40 --sub-models 2 --threads 1").status, 0);
  const std::string hash = summary().at("state_hash");
  for (const char* options : {"--threads 2", "--threads 5 --scheduler barrier", "--threads 3 --scheduler stealing"}) {
    ASSERT_EQ(run(good, std::string("--steps 40 --sub-models 2 ") + options).status, 0);
    EXPECT_EQ(summary().at("state_hash"), hash) << options;
  }
}

TEST_F(Command, OptionsReachTheScene) {
  const Ended ended = run(good,
                          "--steps 7 --substeps 3 --dt 0.002 --iterations 4 --sub-models 2 --split slabs --set "
                          "elements.0.items.0.id=9 --quiet");
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_EQ(ended.text, "");
  const Json s = summary();
  EXPECT_EQ(s.at("steps"), 7);
  EXPECT_EQ(s.at("substeps"), 3);
  EXPECT_EQ(s.at("dt"), 0.002);
  EXPECT_EQ(s.at("sub_models"), 2);
  EXPECT_EQ(s.at("split"), "slabs");
}

}  // namespace
}  // namespace moraine
