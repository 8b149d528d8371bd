// SPDX-License-Identifier: Apache-2.0
// The moraine command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "commands.hpp"
#include "options.hpp"
#include "physics/errors.hpp"
#include "runtime/run_error.hpp"

namespace {

using moraine::InputError;
using moraine::InvalidStateError;
using moraine::IoError;

int fail(const std::string& text, int status) {
  std::cerr << "moraine: " << text << '\n';
  return status;
}

/// Exit status by kind of error; a failed task counts as what it threw.
int guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const moraine::runtime::RunError& e) {
    return guarded([&]() -> int { std::rethrow_exception(e.cause()); });
  } catch (const std::invalid_argument& e) {  // an unknown scheduler or number of threads
    return fail(e.what(), InputError::exit_status);
  } catch (const InputError& e) {
    return fail(e.what(), InputError::exit_status);
  } catch (const InvalidStateError& e) {
    return fail(e.what(), InvalidStateError::exit_status);
  } catch (const std::exception& e) {
    return fail(e.what(), IoError::exit_status);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Discrete element models cut into many worlds of a rigid-body engine, acting as one."};
  app.require_subcommand(1);
  app.set_version_flag("--version", MORAINE_VERSION);

  moraine::app::SceneOptions run_options, info_options;
  bool quiet = false;
  CLI::App* run = app.add_subcommand("run", "run a scene");
  run_options.add_to(*run);
  run->add_flag("--quiet", quiet, "no progress, only the closing summary's warnings")->envname("MORAINE_QUIET");
  CLI::App* info = app.add_subcommand("info", "what would run, without running it");
  info_options.add_to(*info);
  CLI::App* list = app.add_subcommand("list", "engines, splits, couplings, schedulers, output formats");
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
  return guarded([&] {
    if (*run) {
      moraine::Scene scene = run_options.read();
      scene.output.quiet = scene.output.quiet || quiet;
      return moraine::app::run(scene);
    }
    if (*info) return moraine::app::info(info_options.read());
    if (*list) return moraine::app::list();
    return moraine::app::render(folder, width);
  });
}
