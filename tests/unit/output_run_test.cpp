// SPDX-License-Identifier: Apache-2.0
// The background writer, reading a run back, the summary and the progress line.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "output/background.hpp"
#include "output/file.hpp"
#include "output/picture.hpp"
#include "output/picture/png.hpp"
#include "output/progress.hpp"
#include "output/read_frames.hpp"
#include "output/summary.hpp"
#include "output_sample.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

void expect_same(const Frame::Bodies& a, const Frame::Bodies& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.sub_model, b.sub_model);
  EXPECT_EQ(a.shape, b.shape);
  ASSERT_EQ(a.state.size(), b.state.size());
  for (std::size_t i = 0; i < a.state.size(); ++i) EXPECT_TRUE(sample::same(a.state[i], b.state[i])) << i;
}

TEST(RecordedRun, FramesAndPicturesComeBack) {
  const sample::Folder folder("recorded");
  Scene scene = sample::scene();
  scene.time.label = {"year", 10};
  scene.output.picture_width = 300;
  BackgroundWriter writer(scene, folder / "run");
  for (std::int64_t step : {0, 60, 120}) writer.push(sample::frame(scene, step));
  writer.finish();
  const RecordedRun run(folder / "run");
  ASSERT_EQ(run.times(), (std::vector<double>{0, 30, 60}));
  const Frame frame = run.frame(2), expected = sample::frame(scene, 120);
  EXPECT_EQ(frame.step, 120);
  EXPECT_EQ(frame.time, 60);
  EXPECT_EQ(frame.bonds, expected.bonds);
  expect_same(frame.elements, expected.elements);
  expect_same(frame.ghosts, expected.ghosts);
  EXPECT_EQ(frame.boundary_poses[2].position, expected.boundary_poses[2].position);
  EXPECT_TRUE(read_png(folder / "run/last.png").pixels == draw_picture(run.scene(), frame, 300).pixels);
  EXPECT_TRUE(read_png(folder / "run/first.png").pixels == draw_picture(run.scene(), run.frame(0), 300).pixels);
}

TEST(RecordedRun, SaysWhatIsMissing) {
  const sample::Folder folder("recorded_missing");
  EXPECT_THROW(RecordedRun{folder.path()}, IoError);
  const Scene scene = sample::scene();
  find_writer("pvd").make(scene, folder.path())->write(sample::frame(scene));
  std::filesystem::remove(folder / "frames/ghosts_000120.vtu");
  try {
    RecordedRun(folder.path()).frame(0);
    FAIL() << "expected IoError";
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("ghosts_000120.vtu"), std::string::npos) << e.what();
  }
}

TEST(BackgroundWriter, PassesErrorsOnOnce) {
  const sample::Folder folder("background");
  const Scene scene = sample::scene();
  BackgroundWriter writer(scene, folder / "run");
  std::filesystem::remove_all(folder / "run");
  EXPECT_THROW(
      {
        for (int i = 0; i < 4; ++i) writer.push(sample::frame(scene, i));
        writer.finish();
      },
      IoError);
  EXPECT_NO_THROW(writer.finish());
}

TEST(BackgroundWriter, KeepsTheFirstPictureOverARestart) {
  const sample::Folder folder("background_restart");
  Scene scene = sample::scene();
  scene.output.picture_width = 300;
  const auto write = [&](std::initializer_list<std::int64_t> steps) {
    BackgroundWriter writer(scene, folder.path());
    for (const std::int64_t step : steps) writer.push(sample::frame(scene, step));
    writer.finish();
  };
  write({0, 60});
  const auto first = read_png(folder / "first.png").pixels;
  scene.run.restart = "latest";
  write({120});
  EXPECT_TRUE(read_png(folder / "first.png").pixels == first);
  EXPECT_FALSE(read_png(folder / "last.png").pixels == first);
  scene.run.restart.clear();
  write({120});
  EXPECT_FALSE(read_png(folder / "first.png").pixels == first) << "a run from the start writes over it";
}

TEST(BackgroundWriter, RefusesUnknownFormats) {
  const sample::Folder folder("background_format");
  Scene scene = sample::scene();
  scene.output.formats = {"pvd", "vtx"};
  EXPECT_THROW(BackgroundWriter(scene, folder.path()), InputError);
}

TEST(BackgroundWriter, EndsWithoutFrames) {
  const sample::Folder folder("background_empty");
  const Scene scene = sample::scene();
  BackgroundWriter(scene, folder.path()).finish();
  EXPECT_FALSE(std::filesystem::exists(folder / "last.png"));
}

TEST(Summary, HoldsTheNamesScriptsDependOn) {
  const sample::Folder folder("summary");
  Summary summary;
  summary.state_hash = "0123456789abcdef";
  summary.kinetic_energy = std::numeric_limits<double>::quiet_NaN();
  summary.center_of_mass = {1, 2, 3};
  summary.step_share = {{"step", 0.75}};
  summary.warnings = {"bad byte \xff"};
  write_summary(summary, folder / "summary.json");
  const auto json = nlohmann::json::parse(read_file(folder / "summary.json"));
  for (const char* name : {"scene",
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
                           "time",
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
                           "x95",
                           "overlap",
                           "coupling_residual",
                           "load",
                           "step_share",
                           "recuts",
                           "warnings"}) {
    EXPECT_TRUE(json.contains(name)) << name;
  }
  for (const char* name : {"mean", "max", "final", "fraction_mean", "fraction_final"}) {
    EXPECT_TRUE(json["ghosts"].contains(name)) << name;
  }
  for (const char* name : {"imbalance", "utilisation", "waiting_fraction", "migrations"}) {
    EXPECT_TRUE(json["load"].contains(name)) << name;
  }
  EXPECT_TRUE(json["bonds"].contains("total") && json["bonds"].contains("broken"));
  EXPECT_TRUE(json["momentum_residual"].contains("linear") && json["momentum_residual"].contains("angular"));
  EXPECT_TRUE(json["overlap"].contains("max") && json["overlap"].contains("mean"));
  EXPECT_TRUE(json["kinetic_energy"].is_null());
  EXPECT_EQ(json["center_of_mass"], nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["step_share"]["step"], 0.75);
  EXPECT_TRUE(json["warnings"].is_array());
}

TEST(Summary, TextEndsWithTheWarnings) {
  Summary summary;
  summary.elements = 97038;
  summary.warnings = {"elements are fast"};
  const std::string text = summary_text(summary);
  EXPECT_NE(text.find("97,038 elements"), std::string::npos);
  EXPECT_TRUE(text.ends_with("elements are fast\n"));
}

TEST(Summary, QuantileIsTheNearestRank) {
  Frame::Bodies bodies;
  EXPECT_EQ(quantile(bodies.state, 0, 0.95), 0);
  for (int i = 100; i > 0; --i) {
    bodies.id.push_back(static_cast<ElementId>(i));
    bodies.state.push_back({{Vec3(i, 0, 0), Quat::Identity()}, {}});
  }
  EXPECT_EQ(quantile(bodies.state, 0, 0.95), 95);
  EXPECT_EQ(quantile(bodies.state, 0, 0), 1);
  EXPECT_EQ(quantile(bodies.state, 0, 1), 100);
}

TEST(Progress, LineTellsStepTimeSpeedAndWhatIsLeft) {
  Scene scene = sample::scene();
  scene.time.substeps = 2;
  scene.time.label = {"year", 10};
  EXPECT_EQ(progress_line(scene, {60, 30, 3, 1.25}, 30, 15),
            "step 60/120  600 year  40 element-steps/s  30 s left  3 ghosts (30.0 %)  imbalance 1.25");
  EXPECT_NE(progress_line(scene, {}, 0, 0).find("unknown left"), std::string::npos);
}

TEST(Progress, QuietPrintsNothing) {
  const Scene scene = sample::scene();
  testing::internal::CaptureStderr();
  Progress progress(scene, true);
  progress.update({1, 0.5, 0, 1});
  progress.finish();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace moraine
