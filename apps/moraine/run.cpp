// SPDX-License-Identifier: Apache-2.0
// moraine run: cut the scene, step it, write what is asked for, sum it up.
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include "alike.hpp"
#include "capture.hpp"
#include "commands.hpp"
#include "identity.hpp"
#include "interrupted.hpp"
#include "output/background.hpp"
#include "output/progress.hpp"
#include "physics/errors.hpp"
#include "runtime/cores.hpp"
#include "runtime/simulation.hpp"

namespace moraine::app {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Of all threads of this process.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::filesystem::path folder_of(const Scene& scene) {
  if (!scene.output.folder.empty()) return scene.output.folder;
  return std::filesystem::path("out") / scene.name;
}

int status_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const InputError&) {
    return InputError::exit_status;
  } catch (const InvalidStateError&) {
    return InvalidStateError::exit_status;
  } catch (...) {
    return IoError::exit_status;
  }
}

std::filesystem::path checkpoint_folder(const Scene& scene) { return folder_of(scene) / "checkpoints"; }

/// The folder that --restart means.
std::filesystem::path restart_folder(const Scene& scene) {
  if (scene.run.restart != "latest") return scene.run.restart;
  const auto own = runtime::list_checkpoints(checkpoint_folder(scene), identity(scene));
  if (!own.empty()) return own.front();
  const auto complete = runtime::list_checkpoints(checkpoint_folder(scene));
  if (complete.empty())
    throw InputError(
        fmt::format("--restart latest: {} holds no complete checkpoint, expected one made with "
                    "--checkpoint-every",
                    checkpoint_folder(scene).string()));
  return complete.front();  // of another run, which is said when it is refused
}

/// A run in progress: the model, where its results go (from rank 0), and the clock.
class Run {
 public:
  Run(const Scene& scene, runtime::Transport& transport)
      : scene_(scene),
        transport_(transport),
        model_(scene, transport),
        simulation_(model_, options(scene, transport),
                    {.until_next_stop = [this](std::int64_t round) { return until_next_frame(round); },
                     .at_epoch_end = [this](std::int64_t round) { epoch_done(round); }}),
        first_round_(restored()),
        progress_(scene, scene.output.quiet || !writes(), first_round_ / scene.time.substeps) {
    if (writes()) writer_.emplace(scene, folder_of(scene));
  }

  Summary go() {
    if (first_round_ == 0) write_frame(0);
    const auto loop = Clock::now();
    const double cpu = processor_seconds();
    Spent spent{.rounds = rounds() - first_round_};
    simulation_.run(first_round_, spent.rounds);
    spent.loop_wall_s = since(loop);
    spent.loop_cpu_s = processor_seconds() - cpu;
    model_.conclude(rounds());
    progress_.finish();
    print_news();
    write_frame(scene_.time.steps);
    if (writes()) writer_->finish();
    spent.wall_s = since(begin_);
    return summarise(model_, simulation_, spent);
  }

 private:
  static runtime::Options options(const Scene& scene, runtime::Transport& transport) {
    const RunSettings& run = scene.run;
    const std::int64_t substeps = scene.time.substeps;
    runtime::Options o;
    o.threads = run.threads;
    o.scheduler = run.scheduler;
    o.transport = &transport;
    o.balance.balancer = run.balancer;
    o.balance.predictor = run.load_prediction;
    o.balance.every = run.balance_every * substeps;
    o.balance.measured = run.balance_measured;
    o.checkpoint.folder = checkpoint_folder(scene);
    o.checkpoint.every = run.checkpoint_every * substeps;
    o.checkpoint.run = identity(scene);
    o.trace = {.file = run.trace,
               .from = run.trace_window.from,
               .to = run.trace_window.to,
               .every = run.trace_window.every,
               .title = scene.name,
               .rounds_per_step = substeps};
    o.status_of = status_of;
    return o;
  }

  /// The first round to run. All ranks restore the same checkpoint, so an error is one of all.
  std::int64_t restored() {
    if (scene_.run.restart.empty()) return 0;
    const std::filesystem::path folder = restart_folder(scene_);
    const std::int64_t round = simulation_.restore(folder);
    const std::int64_t substeps = scene_.time.substeps;
    if (round > rounds())
      throw InputError(fmt::format("{}: the checkpoint is of step {}, expected at most the {} steps of this run",
                                   folder.string(), (round + substeps - 1) / substeps, scene_.time.steps));
    return round;
  }

  bool writes() const { return transport_.rank() == 0; }
  std::int64_t rounds() const { return scene_.time.steps * scene_.time.substeps; }
  std::int64_t rounds_per_frame() const { return std::int64_t{scene_.output.every} * scene_.time.substeps; }

  /// Rounds from `round` to the next frame, or to the end.
  std::int64_t until_next_frame(std::int64_t round) const {
    const std::int64_t period = rounds_per_frame();
    return period > 0 ? std::min(rounds() - round, period - round % period) : rounds() - round;
  }

  void epoch_done(std::int64_t round) {
    const std::int64_t step = round / scene_.time.substeps;
    progress_.update({step, static_cast<double>(round) * scene_.time.substep(), model_.ghosts_at_epoch(),
                      simulation_.load().imbalance()});
    print_news();
    const std::int64_t period = rounds_per_frame();
    if (period > 0 && round % period == 0 && round < rounds()) write_frame(step);
  }

  void print_news() {
    for (const std::string& text : model_.take_news())
      if (writes()) std::cerr << "moraine: warning: " << text << '\n';
  }

  void write_frame(std::int64_t step) {
    Frame frame = capture(model_, transport_, step);
    if (writes()) writer_->push(std::move(frame));
  }

  const Scene& scene_;
  runtime::Transport& transport_;
  Clock::time_point begin_ = Clock::now();
  CoupledModel model_;
  runtime::Simulation simulation_;
  std::int64_t first_round_;
  Progress progress_;
  std::optional<BackgroundWriter> writer_;  ///< on rank 0
};

/// What this rank may use, for someone who wonders why it is slow.
void print_layout(const Scene& scene, runtime::Transport& transport) {
  const int threads = scene.run.threads > 0 ? scene.run.threads : runtime::threads_for(transport);
  const std::string own =
      fmt::format("rank {}: {} thread(s) on cores {}", transport.rank(), threads, runtime::bound_to());
  const auto* letters = reinterpret_cast<const std::byte*>(own.data());
  for (const runtime::Bytes& b : transport.gather(0, runtime::Bytes(letters, letters + own.size())))
    std::cerr << std::string_view(reinterpret_cast<const char*>(b.data()), b.size()) << '\n';
}

/// A folder that cannot be written is wrong input, and is found out before anything is computed.
void check_folder(const std::filesystem::path& folder) {
  const std::filesystem::path probe = folder / ".writable";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::ofstream(probe))
    throw InputError(fmt::format("{}: cannot write there, expected a folder for results (--out)", folder.string()));
  std::filesystem::remove(probe, error);
}

/// The same for the trace.
void check_trace(const std::filesystem::path& file) {
  if (file.empty()) return;
  const bool there = std::filesystem::exists(file);
  if (!std::ofstream(file, std::ios::app))
    throw InputError(fmt::format("{}: cannot write there, expected a file for the trace (--trace)", file.string()));
  if (!there) std::filesystem::remove(file);
}

std::string resume_note(const Scene& scene) {
  return fmt::format("moraine: stopped; to go on from the last checkpoint in {}, add --restart latest\n",
                     checkpoint_folder(scene).string());
}

Summary run_all(const Scene& scene, runtime::Transport& transport) {
  if (scene.run.checkpoint_every == 0) return Run(scene, transport).go();
  const LastWord last_word(resume_note(scene), folder_of(scene) / ".stopped");
  try {
    return Run(scene, transport).go();
  } catch (const runtime::RunError&) {
    if (transport.rank() == 0) std::cerr << resume_note(scene);
    throw;
  } catch (const InvalidStateError&) {
    if (transport.rank() == 0) std::cerr << resume_note(scene);
    throw;
  }
}

}  // namespace

int run(const Scene& scene, runtime::Transport& transport) {
  check_alike(scene, transport);
  const bool first = transport.rank() == 0;
  if (first) check_folder(folder_of(scene));
  if (first) check_trace(scene.run.trace);
  if (first)
    for (const std::string& warning : scene.warnings) std::cerr << "moraine: warning: " << warning << '\n';
  if (transport.ranks() > 1 && !scene.output.quiet) print_layout(scene, transport);
  const Summary summary = run_all(scene, transport);
  if (!first) return 0;
  const std::filesystem::path folder = folder_of(scene);
  write_summary(summary, folder / "summary.json");
  if (!scene.output.quiet) std::cout << summary_text(summary) << "results in " << folder.string() << '\n';
  return 0;
}

}  // namespace moraine::app
