// SPDX-License-Identifier: Apache-2.0
// moraine run: cut the scene, step it, write what is asked for, sum it up.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "capture.hpp"
#include "commands.hpp"
#include "output/background.hpp"
#include "output/progress.hpp"
#include "physics/errors.hpp"
#include "runtime/simulation.hpp"

namespace moraine::app {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::filesystem::path folder_of(const Scene& scene) {
  if (!scene.output.folder.empty()) return scene.output.folder;
  return std::filesystem::path("out") / scene.name;
}

/// A run in progress: the model, where its results go, and the clock.
class Run {
 public:
  explicit Run(const Scene& scene)
      : scene_(scene),
        model_(scene),
        writer_(scene, folder_of(scene)),
        progress_(scene, scene.output.quiet),
        simulation_(model_, options(scene),
                    {.until_next_stop = [this](std::int64_t round) { return until_next_frame(round); },
                     .at_epoch_end = [this](std::int64_t round) { epoch_done(round); },
                     .observer = nullptr}) {}

  Summary go() {
    writer_.push(capture(model_, 0));
    const auto loop = Clock::now();
    simulation_.run(0, rounds());
    const double loop_wall = since(loop);
    progress_.finish();
    writer_.push(capture(model_, scene_.time.steps));
    writer_.finish();
    return summarise(model_, simulation_, since(begin_), loop_wall);
  }

 private:
  static runtime::Options options(const Scene& scene) {
    return {.threads = scene.run.threads,
            .scheduler = scene.run.scheduler,
            .measured_cost = false,
            .check_messages = false};
  }

  std::int64_t rounds() const { return scene_.time.steps * scene_.time.substeps; }
  std::int64_t rounds_per_frame() const { return std::int64_t{scene_.output.every} * scene_.time.substeps; }

  /// Rounds from `round` to the next frame, or to the end.
  std::int64_t until_next_frame(std::int64_t round) const {
    const std::int64_t period = rounds_per_frame();
    return period > 0 ? std::min(rounds() - round, period - round % period) : rounds() - round;
  }

  void epoch_done(std::int64_t round) {
    const std::int64_t step = round / scene_.time.substeps;
    progress_.update({step, static_cast<double>(round) * scene_.time.substep(), model_.ghosts_now(),
                      simulation_.load().imbalance()});
    const std::int64_t period = rounds_per_frame();
    if (period > 0 && round % period == 0 && round < rounds()) writer_.push(capture(model_, step));
  }

  const Scene& scene_;
  Clock::time_point begin_ = Clock::now();
  CoupledModel model_;
  BackgroundWriter writer_;
  Progress progress_;
  runtime::Simulation simulation_;
};

/// A folder that cannot be written is wrong input, and is found out before anything is computed.
void check_folder(const std::filesystem::path& folder) {
  const std::filesystem::path probe = folder / ".writable";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::ofstream(probe))
    throw InputError(fmt::format("{}: cannot write there, expected a folder for results (--out)", folder.string()));
  std::filesystem::remove(probe, error);
}

}  // namespace

int run(const Scene& scene) {
  check_folder(folder_of(scene));
  for (const std::string& warning : scene.warnings) std::cerr << "moraine: warning: " << warning << '\n';
  const Summary summary = Run(scene).go();
  const std::filesystem::path folder = folder_of(scene);
  write_summary(summary, folder / "summary.json");
  if (!scene.output.quiet) std::cout << summary_text(summary) << "results in " << folder.string() << '\n';
  return 0;
}

}  // namespace moraine::app
