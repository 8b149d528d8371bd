// SPDX-License-Identifier: Apache-2.0
// The sections `time`, `run` and `output`.
#include <fmt/format.h>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "physics/scene/draft.hpp"

namespace moraine {
namespace {

constexpr int most = std::numeric_limits<int>::max();
constexpr int most_threads = 4096;
constexpr int most_pixels = 4096;

int read_int(const Node& node, const std::string& key, int fallback, int low, int high = most) {
  return static_cast<int>(node.integer(key, fallback, low, high));
}

double read_fraction(const Node& node, const std::string& key, double fallback) {
  const auto found = node.find(key);
  return found ? found->within(0, 1) : fallback;
}

std::int64_t read_steps(const Node& node, double dt) {
  constexpr double most_steps = 1e15;
  if (node.one_of({"steps", "duration"}) == "steps")
    return node.at("steps").integer(0, static_cast<std::int64_t>(most_steps));
  const Node duration = node.at("duration");
  const double steps = std::ceil(duration.not_negative() / dt - 1e-6);
  if (steps > most_steps)
    duration.fail(fmt::format("the duration is {} steps, expected at most {}", steps, most_steps));
  return static_cast<std::int64_t>(std::max(steps, 0.0));
}

/// Rounds are counted in 64 bits.
int read_substeps(const Node& node, std::int64_t steps) {
  const int substeps = read_int(node, "substeps", 1, 1);
  const std::int64_t most_steps = std::numeric_limits<std::int64_t>::max() / substeps;
  if (steps > most_steps)
    node.at("substeps")
        .fail(fmt::format("{} steps of {} substeps cannot be counted, expected at most {} steps", steps, substeps,
                          most_steps));
  return substeps;
}

void read_label(const Node& node, TimeSettings::Label& label) {
  node.allow({"unit", "per_step"});
  label.unit = node.at("unit", "the name of the unit").text();
  label.per_step = node.at("per_step", "units per step").positive();
}

/// balance_by: measured or counted.
bool read_measured(const Node& node) {
  const auto found = node.find("balance_by");
  if (!found || found->text() == "measured") return true;
  if (found->text() != "counted")
    found->fail(fmt::format("unknown kind of load '{}', expected measured or counted", found->text()));
  return false;
}

int read_sub_models(const Node& node) {
  const auto found = node.find("sub_models");
  if (!found || found->raw() == "auto") return 0;
  return static_cast<int>(found->integer(1, most));
}

std::vector<int> read_owners(const Node& node) {
  std::vector<int> counts;
  if (const auto found = node.find("owners"))
    for (const Node& count : found->items("how many sub-models each rank owns"))
      counts.push_back(static_cast<int>(count.integer(0, most)));
  return counts;
}

/// "FROM:TO" or "FROM:TO:EVERY".
RunSettings::TraceWindow read_window(const Node& node) {
  RunSettings::TraceWindow w;
  const std::string text = node.text();
  int used = 0;
  const int found =
      std::sscanf(text.c_str(), "%" SCNd64 ":%" SCNd64 "%n:%" SCNd64 "%n", &w.from, &w.to, &used, &w.every, &used);
  if (found < 2 || used != static_cast<int>(text.size()) || w.from < 0 || w.to <= w.from || w.every < 1)
    node.fail(fmt::format("'{}' is no window of steps, expected FROM:TO or FROM:TO:EVERY with 0 <= FROM < TO", text));
  return w;
}

}  // namespace

void read_time(const Node& root, TimeSettings& time) {
  const Node node = root.at("time", "dt and steps or duration");
  node.allow({"dt", "steps", "duration", "substeps", "label"});
  time.dt = node.at("dt", "the length of a step [s]").positive();
  time.steps = read_steps(node, time.dt);
  time.substeps = read_substeps(node, time.steps);
  if (const auto label = node.find("label")) read_label(*label, time.label);
}

void read_run(const Node& root, RunSettings& run) {
  const auto node = root.find("run");
  if (!node) return;
  node->allow({"engine",         "engine_profile",
               "sub_models",     "split",
               "coupling",       "coupling_leak",
               "skin",           "recut_ghost_share",
               "iterations",     "overlap_recovery",
               "scheduler",      "threads",
               "balancer",       "balance_every",
               "balance_by",     "checkpoint_every",
               "restart",        "trace",
               "trace_window",   "max_speed",
               "owners",         "skip_threshold",
               "load_prediction"});
  run.engine = node->text("engine", run.engine);
  run.engine_profile = node->text("engine_profile", run.engine_profile);
  run.sub_models = read_sub_models(*node);
  run.split = node->text("split", run.split);
  run.coupling = node->text("coupling", run.coupling);
  if (const auto leak = node->find("coupling_leak")) run.coupling_leak = leak->within(0, 1);
  run.skin = node->not_negative("skin", run.skin);
  run.recut_ghost_share = node->not_negative("recut_ghost_share", run.recut_ghost_share);
  run.skip_threshold = node->not_negative("skip_threshold", run.skip_threshold);
  run.iterations = read_int(*node, "iterations", run.iterations, 1);
  run.overlap_recovery = read_fraction(*node, "overlap_recovery", run.overlap_recovery);
  run.scheduler = node->text("scheduler", run.scheduler);
  run.threads = read_int(*node, "threads", run.threads, 0, most_threads);
  run.balancer = node->text("balancer", run.balancer);
  run.owners = read_owners(*node);
  run.balance_every = read_int(*node, "balance_every", run.balance_every, 1);
  run.balance_measured = read_measured(*node);
  run.load_prediction = node->text("load_prediction", run.load_prediction);
  run.checkpoint_every = read_int(*node, "checkpoint_every", run.checkpoint_every, 0);
  run.restart = node->text("restart", run.restart);
  run.trace = node->text("trace", run.trace);
  if (const auto window = node->find("trace_window")) run.trace_window = read_window(*window);
  run.max_speed = node->not_negative("max_speed", run.max_speed);
}

void read_output(const Node& root, OutputSettings& output) {
  const auto node = root.find("output");
  if (!node) return;
  node->allow({"folder", "quiet", "every", "formats", "pictures", "picture_width"});
  output.folder = node->text("folder", output.folder);
  output.quiet = node->boolean("quiet", output.quiet);
  output.every = read_int(*node, "every", output.every, 0);
  output.pictures = node->boolean("pictures", output.pictures);
  output.picture_width = read_int(*node, "picture_width", output.picture_width, 16, most_pixels);
  const auto formats = node->find("formats");
  if (!formats) return;
  output.formats.clear();
  for (const Node& item : formats->items("a list of formats")) {
    static const std::vector<std::string> known = {"pvd", "vtkhdf", "lammps_dump", "csv"};
    const std::string format = item.text();
    if (std::find(known.begin(), known.end(), format) == known.end()) {
      item.fail(fmt::format("unknown format '{}', expected pvd, vtkhdf, lammps_dump or csv", format));
    }
    output.formats.push_back(format);
  }
}

}  // namespace moraine
