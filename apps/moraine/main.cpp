// SPDX-License-Identifier: Apache-2.0
// The moraine command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "physics/errors.hpp"
#include "profile.hpp"
#include "replay.hpp"
#include "runtime/migrate/checkpoint.hpp"
#include "runtime/run_error.hpp"
#include "runtime/transport/mpi_session.hpp"
#include "tradeoff.hpp"
#include "tune.hpp"

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
    return Trouble{e.what(), InvalidStateError::exit_status, true};
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

// What can be chosen for each command.

struct RunChoices {
  moraine::app::SceneOptions scene;
  bool quiet = false;

  void add_to(CLI::App& command) {
    scene.add_to(command);
    command.add_flag("--quiet", quiet, "no progress, only the closing summary's warnings")->envname("MORAINE_QUIET");
  }
  moraine::Scene read() const {
    moraine::Scene read = scene.read();
    read.output.quiet = read.output.quiet || quiet;
    return read;
  }
};

struct InfoChoices {
  moraine::app::SceneOptions scene;
  int ranks = 1;

  void add_to(CLI::App& command) {
    scene.add_to(command);
    command.add_option("--ranks", ranks, "ranks that would share the scene")->check(CLI::PositiveNumber);
  }
};

struct RenderChoices {
  std::string folder;
  int width = 1200;

  void add_to(CLI::App& command) {
    command.add_option("folder", folder, "folder of a run")->required();
    command.add_option("--width", width, "pixels")->check(CLI::Range(200, 8000));
  }
};

struct NoChoices {
  void add_to(CLI::App&) {}
};

/// The command as it was given, without the folder of the program.
std::string words(int argc, char** argv) {
  std::string text = "moraine";
  for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
  return text;
}

int run_everywhere(const RunChoices& choices) {
  moraine::runtime::MpiSession session;
  return guarded(session.transport(), [&] { return moraine::app::run(choices.read(), session.transport()); });
}

/// A table of commands, each with what can be chosen for it.
class Commands {
 public:
  explicit Commands(CLI::App& app) : app_(app) {}

  template <class Choices>
  void add(const char* name, const char* help, std::function<int(const Choices&)> call) {
    const auto choices = std::make_shared<Choices>();
    CLI::App* command = app_.add_subcommand(name, help);
    choices->add_to(*command);
    rows_.push_back({command, [choices, call] { return call(*choices); }});
  }

  /// Does what the command line asks for.
  int call() const {
    for (const Row& row : rows_)
      if (*row.command) return row.call();
    return InputError::exit_status;
  }

 private:
  struct Row {
    CLI::App* command;
    std::function<int()> call;
  };
  CLI::App& app_;
  std::vector<Row> rows_;
};

/// A command that one process does alone.
template <class Choices, class Function>
std::function<int(const Choices&)> alone(const Function& command) {
  return [command](const Choices& choices) { return guarded([&] { return command(choices); }); };
}

void add_all(Commands& commands, const std::string& words) {
  namespace app = moraine::app;
  commands.add<RunChoices>("run", "run a scene", run_everywhere);
  commands.add<InfoChoices>("info", "what would run, without running it", alone<InfoChoices>([](const InfoChoices& c) {
                              return app::info(c.scene.read(), c.ranks);
                            }));
  commands.add<NoChoices>("list", "engines, splits, couplings, schedulers, output formats",
                          alone<NoChoices>([](const NoChoices&) { return app::list(); }));
  commands.add<app::ProfileChoices>("profile", "where the time of a traced run went, and what would help",
                                    alone<app::ProfileChoices>(app::profile));
  commands.add<app::ReplayChoices>("replay",
                                   "a traced run on other ranks, cores, schedulers and balancers, without running it",
                                   alone<app::ReplayChoices>(app::replay));
  commands.add<app::TradeoffChoices>(
      "tradeoff", "speed against error for a grid of settings",
      alone<app::TradeoffChoices>([words](const app::TradeoffChoices& c) { return app::tradeoff(c, words); }));
  commands.add<app::TuneChoices>("tune", "the cheapest settings whose error is below a wish",
                                 alone<app::TuneChoices>(app::tune));
  commands.add<RenderChoices>("render", "pictures of a run's frames", alone<RenderChoices>([](const RenderChoices& c) {
                                return app::render(c.folder, c.width);
                              }));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Discrete element models cut into many worlds of a rigid-body engine, acting as one."};
  app.require_subcommand(1);
  app.set_version_flag("--version", MORAINE_VERSION);
  Commands commands(app);
  add_all(commands, words(argc, argv));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : InputError::exit_status;
  }
  return commands.call();
}
