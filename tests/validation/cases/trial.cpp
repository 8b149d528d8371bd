// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

std::size_t parts_of(const Setting& setting, const Scene& scene) {
  if (!setting.cut) return 1;
  const auto most = static_cast<std::size_t>(scene.run.sub_models > 0 ? scene.run.sub_models : 3);
  return std::min(most, scene.elements.size());
}

}  // namespace

bool Case::runs_with(const Engine& engine) const {
  const bool springs = Setting{std::string(engine.name)}.springs();
  return (!(needs & needs_boxes) || engine.supports(Geometry{Cuboid{}})) && (!(needs & needs_bonds) || engine.bonds) &&
         (!(needs & needs_impulses) || !springs) && (!(needs & needs_springs) || springs);
}

std::vector<Case> needing(Needs needs, std::vector<Case> cases) {
  for (Case& c : cases) c.needs = needs;
  return cases;
}

ModelRun trial(const Setting& setting, const std::string& text, double dt, std::vector<Override> overrides,
               double part_of_limit) {
  overrides.push_back(set("run.engine", setting.engine));
  const Scene as_written = scene_of(text, overrides);
  const StepLimit limit = find_engine(setting.engine).step_limit(as_written);
  overrides.push_back(set("time.dt", std::min(dt, part_of_limit * limit.substep)));
  overrides.push_back(set("run.sub_models", static_cast<double>(parts_of(setting, as_written))));
  overrides.push_back(set("run.split", "slabs"));
  return ModelRun(scene_of(text, overrides));
}

std::string masses_on_springs(const std::string& items, const std::string& bonds) {
  return "materials: {ball: {density: 1000}}\nelements:\n  - {packing: list, shape: {sphere: 0.1}, mass: 1, items: [" +
         items + "]}\ntime: {dt: 1e-3, steps: 1}\nbonds: [" + bonds + "]\n" + weightless;
}

std::string ball(const Setting& setting, const std::string& material) {
  return setting.springs() ? material + ", normal_stiffness: 1e6" : material;
}

void run_until(ModelRun& run, double seconds) {
  run.steps(std::max(0L, std::lround((seconds - run.time()) / run.scene().time.dt)));
}

double worst_of(std::initializer_list<double> errors) {
  double most = *errors.begin();
  for (const double e : errors)
    if (!(e <= most) && !std::isnan(most)) most = e;
  return most;
}

}  // namespace moraine::test
