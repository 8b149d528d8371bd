// SPDX-License-Identifier: Apache-2.0
// moraine tradeoff and moraine tune, on two spheres that meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "output/file.hpp"
#include "tests/support/shell.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine {
namespace {

using Json = nlohmann::json;
using test::Ended;
using test::shell;

/// What is right is known: momentum stays, restitution takes the rest.
const std::string scene = R"(
name: meeting
parameters: {speed: 1}
gravity: [0, 0, 0]
materials: {ball: {density: 1000, restitution: 0.5}}
elements:
  - {packing: list, shape: {sphere: 0.5}, items: [{at: [-0.6, 0, 0], velocity: [speed, 0, 0]}, {at: [0.6, 0, 0]}]}
time: {dt: 1 / 100, duration: 0.5}
tradeoff:
  seeds: 3
  grid:
    - {engine: [bullet, impulse], substeps: [1, 4], sub_models: 1}
expect:
  com_x: speed / 2 * 0.5
  kinetic_energy: {value: 1000 * pi / 6 * (0.25 + 0.0625) * speed^2, scale: 1000 * pi / 12 * speed^2}
)";

class Study : public testing::Test {
 protected:
  Ended command(const std::string& name, const std::string& options = "") const {
    return shell("moraine " + name + " " + file_.string() + " --out " + out() + " --jobs 2 " + options);
  }
  void rewrite(const std::string& text) { file_ = folder_.write("scene.yaml", text); }
  std::string out() const { return (file_.parent_path() / "out").string(); }
  Json read(const std::string& name) const { return Json::parse(read_file(std::filesystem::path(out()) / name)); }
  std::vector<std::filesystem::path> records() const {
    std::vector<std::filesystem::path> all;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(out()) / "runs"))
      all.push_back(entry.path());
    return all;
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.write("scene.yaml", scene);
};

bool says(const Ended& ended, const std::string& part) { return ended.text.find(part) != std::string::npos; }

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(Study, MeasuresEverySetting) {
  const Ended ended = command("tradeoff");
  ASSERT_EQ(ended.status, 0) << ended.text;
  const Json all = read("settings.json");
  ASSERT_EQ(all.at("rows").size(), 4U);
  EXPECT_FALSE(all.contains("reference")) << "all that counts is expected";
  EXPECT_FALSE(all.at("front").empty());
  EXPECT_EQ(all.at("runs_at_once"), 2);
  for (const Json& row : all.at("rows")) {
    EXPECT_EQ(row.at("seeds"), 3);
    EXPECT_GT(row.at("speed"), 0);
    EXPECT_LT(row.at("error").at("high"), 0.05) << row;
    EXPECT_GT(row.at("observables").at("com_x").at("deviation"), 0) << "seeds differ";
  }
  const std::string csv = read_file(std::filesystem::path(out()) / "settings.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(read_file(std::filesystem::path(out()) / "plot.svg").find("</svg>"), std::string::npos);
}

/// Of what moves against the common centre one minus restitution squared is lost, and nothing gained.
TEST_F(Study, KeepsTheLedgerOfEnergy) {
  const std::string relative = "1000 * pi / 6 / 4 * speed^2";
  rewrite(changed(scene, "expect:",
                  "expect:\n  dissipated: {value: 0.75 * " + relative + ", scale: " + relative +
                      "}\n  energy_gained: {value: 0, scale: " + relative + "}"));
  ASSERT_EQ(command("tradeoff").status, 0);
  const Json all = read("settings.json");
  ASSERT_EQ(all.at("rows").size(), 4U);
  for (const Json& row : all.at("rows")) {
    EXPECT_LT(row.at("error").at("high"), 0.05) << row;
    EXPECT_TRUE(row.at("observables").contains("dissipated") && row.at("observables").contains("energy_gained"));
  }
}

TEST_F(Study, MeasuresWhatTheFloorCarries) {
  rewrite(R"(
name: resting
gravity: [0, 0, -9.81]
materials: {ball: {density: 1000, restitution: 0}}
elements:
  - {packing: list, shape: {sphere: 0.5}, items: [{at: [0, 0, 0.5]}, {at: [2, 0, 0.5]}]}
boundaries: [{plane: {normal: [0, 0, 1]}, material: ball}]
time: {dt: 1 / 100, duration: 1}
tradeoff: {seeds: 2, grid: [{engine: [bullet, impulse], sub_models: [1, 2]}]}
expect: {floor_force: 2 * 1000 * pi / 6 * 9.81}
)");
  const Ended ended = command("tradeoff");
  ASSERT_EQ(ended.status, 0) << ended.text;
  const Json all = read("settings.json");
  ASSERT_EQ(all.at("rows").size(), 4U);
  for (const Json& row : all.at("rows")) EXPECT_LT(row.at("error").at("high"), 0.01) << row;
}

TEST_F(Study, ItsCommandsRunWhatItMeasured) {
  ASSERT_EQ(command("tradeoff").status, 0);
  const Json all = read("settings.json");
  const Json& row = all.at("rows").at(all.at("front").at(0).get<std::size_t>());
  const std::string line = row.at("command").get<std::string>() + " --quiet --out " + out() + "/again";
  ASSERT_EQ(shell(line).status, 0) << line;
  const Json again = read("again/summary.json");
  EXPECT_EQ(again.at("substeps"), row.at("substeps"));
  EXPECT_NEAR(again.at("kinetic_energy"), row.at("observables").at("kinetic_energy").at("mean"), 5);
}

TEST_F(Study, GoesOnWhereItStopped) {
  ASSERT_EQ(command("tradeoff").status, 0);
  ASSERT_EQ(records().size(), 12U);
  std::filesystem::remove(records().front());
  const Ended ended = command("tradeoff");
  EXPECT_TRUE(says(ended, "11 of 12 runs are there already")) << ended.text;
  EXPECT_TRUE(says(ended, "   1 of 1  ")) << ended.text;
  EXPECT_EQ(records().size(), 12U);
}

TEST_F(Study, NoticesAChangedScene) {
  ASSERT_EQ(command("tradeoff").status, 0);
  rewrite(changed(scene, "density: 1000,", "density: 1200,"));
  const Ended ended = command("tradeoff");
  EXPECT_TRUE(says(ended, "12 finished runs are of another version of the scene")) << ended.text;
  EXPECT_TRUE(says(ended, "12 of 12  ")) << ended.text;
}

/// Libraries of engines are part of the program; a study's runs load those that it would load itself.
TEST_F(Study, NoticesAChangedEngine) {
  const std::string libraries = (file_.parent_path() / "engines").string();
  const std::string there = "export MORAINE_ENGINES=" + libraries + "; ";
  const std::string line = "moraine tradeoff " + file_.string() + " --out " + out();
  const Ended missing = shell("mkdir " + libraries + "; " + there + line);
  EXPECT_TRUE(says(missing, "looked for\n  " + libraries)) << missing.text;
  const std::string copy = "cp $(dirname " MORAINE_COMMAND ")/lib/moraine/*.so " + libraries + "; ";
  EXPECT_FALSE(says(shell(copy + there + line), "looked for")) << "they are there now";
  const Ended other = shell("echo >> " + libraries + "/moraine_bullet.so; " + there + line);
  EXPECT_TRUE(says(other, "12 finished runs are of another version")) << other.text;
}

TEST_F(Study, HasItsFolderToItself) {
  const Ended ended = shell("mkdir " + out() + "; flock " + out() + "/.lock " MORAINE_COMMAND " tradeoff " +
                            file_.string() + " --out " + out());
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(says(ended, "another study writes there")) << ended.text;
}

TEST_F(Study, SpeedsAreOfAsManyRunsAtATimeAsItSays) {
  ASSERT_EQ(command("tradeoff", "--seeds 1").status, 0);
  const Ended ended = shell("moraine tradeoff " + file_.string() + " --out " + out() + " --seeds 1 --jobs 1");
  EXPECT_TRUE(says(ended, "4 finished runs")) << ended.text;
}

TEST_F(Study, SeedsThatChangeNothingSayNothing) {
  rewrite(changed(scene, "{speed: 1}", "{speed: 1, seed: 1}"));
  const Ended ended = command("tradeoff");
  EXPECT_TRUE(says(ended, "its seeds change nothing")) << ended.text;
  EXPECT_EQ(command("tune", "--error 5%").status, 5);
  rewrite(changed(scene.substr(0, scene.find("expect:")), "{speed: 1}", "{speed: 1, seed: 1}"));
  EXPECT_EQ(command("tradeoff").status, 2) << "the reference's neither";
}

TEST_F(Study, OneSeedMakesAFrontToo) {
  const Ended ended = command("tradeoff", "--seeds 1");
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_FALSE(read("settings.json").at("front").empty());
  EXPECT_TRUE(says(ended, "no number of seeds is known that would decide")) << ended.text;
  EXPECT_FALSE(says(ended, "seeds of it")) << ended.text;
}

TEST_F(Study, IsNarrowedByTheCommandLine) {
  ASSERT_EQ(command("tradeoff", "--engine impulse --iterations 1,3 --seeds 2 --observables com_x").status, 0);
  const Json all = read("settings.json");
  EXPECT_EQ(all.at("rows").size(), 4U);
  for (const Json& row : all.at("rows")) {
    EXPECT_EQ(row.at("engine"), "impulse");
    EXPECT_EQ(row.at("seeds"), 2);
    EXPECT_EQ(row.at("error").at("worst"), "com_x");
  }
}

TEST_F(Study, AllSettingsEndAtTheSameTime) {
  ASSERT_EQ(command("tradeoff", "--dt 0.003 --engine impulse --seeds 1").status, 0);
  const Json all = read("settings.json");
  for (const Json& row : all.at("rows"))
    EXPECT_NEAR(row.at("dt").get<double>() * row.at("steps").get<double>(), 0.5, 1e-9);
}

TEST_F(Study, FailedRunsAreRowsWithAReason) {
  rewrite(changed(scene, "sub_models: 1}", "sub_models: 1}\n    - {engine: impulse, run.max_speed: 0.1}"));
  const Ended ended = command("tradeoff");
  ASSERT_EQ(ended.status, 0) << ended.text;
  const Json row = read("settings.json").at("rows").at(4);
  EXPECT_EQ(row.at("status"), 3);
  EXPECT_NE(row.at("reason").get<std::string>().find("element 0"), std::string::npos) << row;
  EXPECT_TRUE(says(ended, "failed: ")) << ended.text;
}

TEST_F(Study, ComparesWithAReference) {
  rewrite(scene.substr(0, scene.find("expect:")));
  const Ended ended = command("tradeoff", "--engine impulse --observables com_x,kinetic_energy");
  ASSERT_EQ(ended.status, 0) << ended.text;
  const Json all = read("settings.json");
  EXPECT_EQ(all.at("reference").at("engine"), "soft_sphere");
  EXPECT_GT(all.at("noise"), 0);
  EXPECT_TRUE(all.at("best").at(2).contains("times_reference"));
}

TEST_F(Study, AStiffReferenceTakesStepsToMatch) {
  const std::string text = scene.substr(0, scene.find("expect:"));
  const auto substeps_at = [&](const std::string& stiffness) {
    rewrite(
        changed(text, "seeds: 3",
                "seeds: 1\n  reference: {engine: soft_sphere, materials.ball.normal_stiffness: " + stiffness + "}"));
    const Ended ended = command("tradeoff", "--engine impulse --observables com_x");
    EXPECT_EQ(ended.status, 0) << ended.text;
    return read("settings.json").at("reference").at("substeps").get<int>();
  };
  const int soft = substeps_at("1e8"), stiff = substeps_at("1e10");
  EXPECT_GT(soft, 1);
  EXPECT_NEAR(stiff, 10 * soft, 10);
}

TEST_F(Study, PeersAreCompared) {
  const Ended ended = command("tradeoff", "--seeds 2 --peer 'other=0.5,com_x=0.3'");
  ASSERT_EQ(ended.status, 0) << ended.text;
  const Json peer = read("settings.json").at("peers").at(0);
  EXPECT_EQ(peer.at("speed"), 0.5);
  EXPECT_NEAR(peer.at("error"), 0.05, 1e-9) << "of a diameter";
}

TEST_F(Study, RefusesWhatItCannotUnderstand) {
  const auto refuses = [&](const Ended& ended, const std::string& part) {
    EXPECT_EQ(ended.status, 2) << ended.text;
    EXPECT_TRUE(says(ended, part)) << ended.text;
  };
  refuses(command("tradeoff", "--observables speed_of_light"), "unknown observable 'speed_of_light'");
  refuses(command("tradeoff", "--peer fast"), "NAME=SPEED");
  refuses(command("tradeoff", "--peer fast=0"), "a speed above 0");
  refuses(command("tradeoff", "--peer fast=inf"), "'inf' is no number");
  refuses(command("tradeoff", "--vary threads=1,2"), "expected --threads");
  refuses(command("tradeoff", "--vary friction"), "key=value");
  refuses(command("tradeoff", "--engine steam"), "unknown engine 'steam'");
  refuses(command("tradeoff", "--clock sun"), "--clock");
  refuses(command("tune"), "--error");
  refuses(command("tune", "--error much"), "per cent");
  refuses(command("tune", "--error 200%"), "between 0 and 1");
  rewrite(changed(scene, "seeds: 3", "sedes: 3"));
  refuses(command("tradeoff"), "scene.yaml:10:3: unknown key 'sedes'");
  rewrite(changed(scene, "substeps: [1, 4]", "subteps: [1, 4]"));
  refuses(command("tradeoff"), "scene.yaml:12:");
  rewrite(changed(scene, "com_x: speed", "com_q: speed"));
  refuses(command("tradeoff"), "scene.yaml:14:10: unknown observable 'com_q'");
}

TEST_F(Study, TuneFindsSettingsThatHoldWhatTheyPromise) {
  const Ended ended = command("tune", "--error 5%");
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(says(ended, "```yaml")) << ended.text;
  const Json found = read("tune.json");
  EXPECT_LE(found.at("found").at("error").at("high"), 0.05);
  EXPECT_GE(found.at("found").at("seeds"), 5);
  ASSERT_EQ(shell(found.at("run").get<std::string>() + " --quiet --out " + out() + "/again").status, 0);
  const double mass = 1000 * 3.14159265 / 6;
  EXPECT_NEAR(read("again/summary.json").at("kinetic_energy"), mass * 0.3125, 0.05 * mass / 2);
}

/// Spheres a hundred times as large take steps ten times as long, which are not the scene's.
TEST_F(Study, WhatAProxyFindsIsWorkedOutForTheScene) {
  rewrite(R"(
name: dropping
parameters: {radius: 0.05}
materials: {ball: {density: 1000, restitution: 0.5}}
elements: [{packing: list, shape: {sphere: radius}, items: [{at: [0, 0, 0]}, {at: [0, 0, 4 * radius]}]}]
time: {dt: 1 / 100, duration: 0.1}
tradeoff: {seeds: 2, proxy: {radius: 5}, grid: [{engine: soft_sphere, limit_share: 1}]}
expect: {com_z: 2 * radius - 9.81 / 2 * 0.1 * 0.1}
)");
  const Ended ended = command("tune", "--proxy-only --error 5%");
  ASSERT_EQ(ended.status, 0) << ended.text;
  const Json found = read("tune.json");
  EXPECT_EQ(found.at("on_proxy"), true);
  const auto run = [&](const std::string& line) {
    EXPECT_EQ(shell(line + " --quiet --out " + out() + "/again").status, 0) << line;
    return read("again/summary.json");
  };
  const Json small = run(found.at("found").at("command")), whole = run(found.at("run"));
  EXPECT_GT(whole.at("substeps"), 5 * small.at("substeps").get<int>());
  EXPECT_TRUE(whole.at("warnings").empty()) << whole.at("warnings");
}

TEST_F(Study, TuneRefusesWhenNothingIsGoodEnough) {
  const Ended bad = command("tune", "--error 2% --set materials.ball.restitution=0.9");
  EXPECT_EQ(bad.status, 5) << bad.text;
  EXPECT_TRUE(says(bad, "No setting in reach")) << bad.text;
  EXPECT_EQ(read("tune.json").at("good_enough"), false);
}

TEST_F(Study, TuneDoesNotClaimWhatSeedsHide) {
  const Ended ended = command("tune", "--error 0.001% --most-seeds 6");
  EXPECT_EQ(ended.status, 5) << ended.text;
  EXPECT_TRUE(says(ended, "would decide") || says(ended, "Not good enough:")) << ended.text;
}

}  // namespace
}  // namespace moraine
