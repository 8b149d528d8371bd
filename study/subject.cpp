// SPDX-License-Identifier: Apache-2.0
#include "study/subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "physics/errors.hpp"
#include "physics/world.hpp"

namespace moraine::study {
namespace {

bool takes_shapes(const Engine& engine, const Scene& scene) {
  return std::all_of(scene.elements.begin(), scene.elements.end(),
                     [&](const Element& e) { return engine.supports(scene.shape_of(e).geometry); });
}

std::vector<Override> joined(std::vector<Override> a, const std::vector<Override>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<Override> overrides_of(const Choices& choices) {
  std::vector<Override> all;
  for (const Choice& c : choices)
    if (c.name != limit_share) all.push_back({key_of(c.name), c.value, c.place});
  return all;
}

/// All runs of a study have as many threads: speeds are compared.
void check_varied(const Choices& choices) {
  for (const Choice& c : choices)
    if (key_of(c.name) == "run.threads")
      throw InputError(fmt::format("{}: {} cannot be varied, expected --threads for all runs", c.place, c.name));
}

/// The first value of each.
Choices choices_of(const AxisBlock& block) {
  Choices all;
  for (const Axis& axis : block) all.push_back({axis.key, axis.values.front(), axis.place});
  return all;
}

const Choice* find(const Choices& choices, std::string_view name) {
  const auto found = std::find_if(choices.begin(), choices.end(), [&](const Choice& c) { return c.name == name; });
  return found == choices.end() ? nullptr : &*found;
}

double share_of(const Choice& choice) {
  double share = 0;
  const char* end = choice.value.data() + choice.value.size();
  const auto [stop, error] = std::from_chars(choice.value.data(), end, share);
  if (error != std::errc() || stop != end || !(share > 0))
    throw InputError(fmt::format("{}: {} is '{}', expected a number above 0", choice.place, choice.name, choice.value));
  return share;
}

bool has_largest_substep(const Engine& engine, const Scene& scene) {
  return std::isfinite(engine.step_limit(scene).substep);
}

bool states_step(const Choices& choices) {
  return std::any_of(choices.begin(), choices.end(), [](const Choice& c) {
    return c.name == limit_share || key_of(c.name) == "time.dt" || key_of(c.name) == "time.substeps";
  });
}

/// Substeps of a share of the engine's largest.
int substeps_within(const Scene& scene, const Choice& choice) {
  const double largest = find_engine(scene.run.engine, scene).step_limit(scene).substep;
  if (!std::isfinite(largest))
    throw InputError(fmt::format("{}: engine {} has no largest substep for this scene, expected substeps instead of {}",
                                 choice.place, scene.run.engine, limit_share));
  return static_cast<int>(std::max(1.0, std::ceil(scene.time.dt / (share_of(choice) * largest) - 1e-9)));
}

void describe(const Scene& scene, Setting& s) {
  const Engine& engine = find_engine(scene.run.engine, scene);
  s.engine = engine.name;
  s.precision = engine.precision;
  s.coupling = scene.run.coupling;
  s.split = scene.run.split;
  s.sub_models = scene.run.sub_models;
  s.dt = scene.time.dt;
  s.steps = scene.time.steps;
  s.substeps = scene.time.substeps;
  s.iterations = scene.run.iterations;
}

/// The usual settings of an engine, around the scene's own step.
AxisBlock usual_settings(const Engine& engine, const Scene& scene) {
  const std::string place = "the usual settings";
  AxisBlock block{{"engine", {std::string(engine.name)}, place}};
  if (has_largest_substep(engine, scene)) {
    block.push_back({std::string(limit_share), {"1", "0.5"}, place});
    return block;
  }
  block.push_back({"substeps", {"1", "2", "4", "8"}, place});
  block.push_back({"iterations", {"1", "2", "5", "10", "20"}, place});
  return block;
}

}  // namespace

std::string Setting::label() const {
  std::string text = fmt::format("{}, {:.4g} s", engine, dt);
  if (substeps > 1) text += fmt::format(" / {}", substeps);
  text += fmt::format(", {} iterations", iterations);
  for (const Choice& c : choices) {
    const std::string key = key_of(c.name);
    if (key != "run.engine" && key != "time.dt" && key != "time.substeps" && key != "run.iterations" &&
        c.name != limit_share)
      text += fmt::format(", {} {}", c.name, c.value);
  }
  return text;
}

Subject::Subject(std::string file, std::vector<Override> overrides, Identify identify)
    : file_(std::move(file)),
      overrides_(std::move(overrides)),
      identify_(std::move(identify)),
      scene_(read_scene(file_, overrides_)),
      duration_(static_cast<double>(scene_.time.steps) * scene_.time.dt) {
  if (!(duration_ > 0)) throw InputError(file_ + ": the scene lasts no time, expected at least a step");
}

Setting Subject::resolve(const Choices& choices) const {
  check_varied(choices);
  Setting s;
  s.choices = choices;
  s.changes = overrides_of(choices);
  Scene scene = read_scene(file_, joined(overrides_, s.changes));
  const auto steps = std::max<std::int64_t>(1, std::llround(duration_ / scene.time.dt));
  if (steps != scene.time.steps || scene.time.dt != scene_.time.dt) {
    s.changes.push_back({"time.dt", fmt::format("{:.12g}", duration_ / static_cast<double>(steps)), "the duration"});
    s.changes.push_back({"time.steps", std::to_string(steps), "the duration"});
    scene = read_scene(file_, joined(overrides_, s.changes));
  }
  if (const Choice* share = find(choices, limit_share)) {
    scene.time.substeps = substeps_within(scene, *share);
    s.changes.push_back({"time.substeps", std::to_string(scene.time.substeps), share->place});
  }
  describe(scene, s);
  s.identity = fmt::format("{}-{}", identify_(scene), scene.time.steps);
  return s;
}

std::vector<Setting> Subject::resolve(const std::vector<Choices>& all) const {
  std::vector<Setting> settings;
  std::set<std::string> seen;
  for (const Choices& choices : all)
    if (Setting s = resolve(choices); seen.insert(s.identity).second) settings.push_back(std::move(s));
  return settings;
}

std::vector<AxisBlock> Subject::grid() const {
  if (!scene_.study.grid.empty()) return scene_.study.grid;
  std::vector<AxisBlock> blocks;
  for (const Engine& engine : engines())
    if (takes_shapes(engine, scene_)) blocks.push_back(usual_settings(engine, scene_));
  return blocks;
}

Choices Subject::reference() const {
  Choices choices = choices_of(scene_.study.reference);
  if (choices.empty()) {
    if (!takes_shapes(find_engine("soft_sphere"), scene_))
      throw InputError(
          fmt::format("{}: engine soft_sphere does not take this scene's shapes, expected tradeoff.reference, or "
                      "right values under expect",
                      file_));
    choices.push_back({"engine", "soft_sphere", "the usual reference"});
  }
  if (states_step(choices)) return choices;
  const Scene scene = read_scene(file_, joined(overrides_, overrides_of(choices)));
  if (has_largest_substep(find_engine(scene.run.engine, scene), scene))
    choices.push_back({std::string(limit_share), "0.5", choices.front().place});
  return choices;
}

Subject Subject::proxy() const {
  return {file_, joined(overrides_, overrides_of(choices_of(scene_.study.proxy))), identify_};
}

/// A thousandth of the speed that an element gains by falling its radius, or of the fastest one's.
double Subject::perturbation_speed() const {
  double fastest = 0;
  for (const Element& e : scene_.elements) fastest = std::max(fastest, e.state.twist.linear.squaredNorm());
  return 1e-3 * std::sqrt(scene_.gravity.norm() * scene_.typical_diameter() + fastest);
}

std::vector<Override> Subject::settings(const Setting& setting) const { return joined(overrides_, setting.changes); }

std::vector<Override> Subject::overrides(const Setting& setting, int seed) const {
  std::vector<Override> all = settings(setting);
  const std::string value = std::to_string(seed);
  if (!scene_.study.seed.empty()) {
    all.push_back({"parameters." + scene_.study.seed, value, "the seed"});
    return all;
  }
  if (scene_.perturbation.speed == 0)
    all.push_back({"perturbation.speed", fmt::format("{:.6g}", perturbation_speed()), "the seed"});
  all.push_back({"perturbation.seed", value, "the seed"});
  return all;
}

std::string Subject::seeds_text() const {
  if (!scene_.study.seed.empty()) return fmt::format("parameter {}", scene_.study.seed);
  const double speed = scene_.perturbation.speed > 0 ? scene_.perturbation.speed : perturbation_speed();
  return fmt::format("random speeds of {:.3g} m/s at the start", speed);
}

}  // namespace moraine::study
