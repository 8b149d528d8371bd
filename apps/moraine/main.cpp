// SPDX-License-Identifier: Apache-2.0
// The moraine command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <iostream>
#include <optional>
#include <thread>

#include "commands.hpp"
#include "options.hpp"
#include "physics/errors.hpp"
#include "replay.hpp"
#include "runtime/migrate/checkpoint.hpp"
#include "runtime/run_error.hpp"
#include "runtime/transport/mpi_session.hpp"

namespace {

using moraine::InputError;
using moraine::InvalidStateError;
using moraine::IoError;

/// An error, said in words that a user can act on.
struct Trouble {
  std::string text;
  int status;
  bool everywhere;  ///< all ranks have agreed on it and end by themselves
};

/// A failed task counts as what it threw.
std::optional<Trouble> attempt(const std::function<void()>& command) {
  try {
    command();
  } catch (const moraine::runtime::RunError& e) {
    return Trouble{e.what(), e.failure().status, true};
  } catch (const moraine::runtime::CheckpointError& e) {
    return Trouble{e.what(), InputError::exit_status, true};
  } catch (const std::invalid_argument& e) {  // an unknown scheduler or number of threads
    return Trouble{e.what(), InputError::exit_status, false};
  } catch (const InputError& e) {
    return Trouble{e.what(), InputError::exit_status, false};
  } catch (const InvalidStateError& e) {
    return Trouble{e.what(), InvalidStateError::exit_status, false};
  } catch (const std::exception& e) {
    return Trouble{e.what(), IoError::exit_status, false};
  }
  return std::nullopt;
}

int report(const Trouble& trouble) {
  std::cerr << "moraine: " << trouble.text << '\n';
  return trouble.status;
}

/// Exit status by kind of error.
int guarded(const std::function<int()>& command) {
  int status = 0;
  const auto trouble = attempt([&] { status = command(); });
  return trouble ? report(*trouble) : status;
}

/// The same for a command that all ranks run. One that fails alone must not leave the others waiting: it ends them all,
/// after a moment in which the first rank, if it has the same trouble, may speak for all.
int guarded(moraine::runtime::Transport& transport, const std::function<int()>& command) {
  int status = 0;
  const auto trouble = attempt([&] { status = command(); });
  if (!trouble) return status;
  if (transport.ranks() == 1) return report(*trouble);
  if (trouble->everywhere) return transport.rank() == 0 ? report(*trouble) : trouble->status;
  if (transport.rank() != 0) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  status = report(*trouble);
  transport.abort(status);
  return status;
}

int run_everywhere(const std::function<moraine::Scene()>& read) {
  moraine::runtime::MpiSession session;
  return guarded(session.transport(), [&] { return moraine::app::run(read(), session.transport()); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Discrete element models cut into many worlds of a rigid-body engine, acting as one."};
  app.require_subcommand(1);
  app.set_version_flag("--version", MORAINE_VERSION);

  moraine::app::SceneOptions run_options, info_options;
  bool quiet = false;
  CLI::App* run_command = app.add_subcommand("run", "run a scene");
  run_options.add_to(*run_command);
  run_command->add_flag("--quiet", quiet, "no progress, only the closing summary's warnings")->envname("MORAINE_QUIET");
  CLI::App* info = app.add_subcommand("info", "what would run, without running it");
  info_options.add_to(*info);
  int ranks = 1;
  info->add_option("--ranks", ranks, "ranks that would share the scene")->check(CLI::PositiveNumber);
  CLI::App* list = app.add_subcommand("list", "engines, splits, couplings, schedulers, output formats");
  moraine::app::ReplayChoices replay_choices;
  CLI::App* replay =
      app.add_subcommand("replay", "a traced run on other ranks, cores, schedulers and balancers, without running it");
  replay_choices.add_to(*replay);
  std::string folder;
  int width = 1200;
  CLI::App* render = app.add_subcommand("render", "pictures of a run's frames");
  render->add_option("folder", folder, "folder of a run")->required();
  render->add_option("--width", width, "pixels")->check(CLI::Range(200, 8000));

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : InputError::exit_status;
  }
  if (*run_command)
    return run_everywhere([&] {
      moraine::Scene scene = run_options.read();
      scene.output.quiet = scene.output.quiet || quiet;
      return scene;
    });
  return guarded([&] {
    if (*info) return moraine::app::info(info_options.read(), ranks);
    if (*list) return moraine::app::list();
    if (*replay) return moraine::app::replay(replay_choices);
    return moraine::app::render(folder, width);
  });
}
