// SPDX-License-Identifier: Apache-2.0
// The same little scene for every engine in the table.
#pragma once

#include <algorithm>
#include <cmath>

#include "tests/support/model_run.hpp"

namespace moraine::test {

/// A dam of 300 spheres in `parts` sub-models, in steps that the engine can take: for 0.3 s, or 100 rounds if that is
/// longer, so that several epochs come by, of which the longest has 64. Springs get restitution 0.5, which lets them
/// take longer steps.
inline std::vector<Override> dam_for(const Engine& engine, int parts) {
  std::vector<Override> out{set("count", 300), set("run.sub_models", parts),
                            set("run.engine", std::string(engine.name))};
  const Override bouncing = set("materials.grain.restitution", 0.5);
  std::vector<Override> springs = out;
  springs.push_back(bouncing);
  const Scene scene = example("dam", springs);
  const double limit = engine.step_limit(scene).substep, dt = std::min(scene.time.dt, 0.8 * limit);
  if (std::isfinite(limit)) out.push_back(bouncing);
  out.push_back(set("time.dt", dt));
  out.push_back(set("time.duration", std::max(0.3, 100 * dt)));
  return out;
}

/// Cases{name, scene, overrides} for all engines.
template <class Case>
std::vector<Case> with_every_engine(std::vector<Case> cases, int parts) {
  for (const Engine& e : engines()) cases.push_back({"dam_" + std::string(e.name), "dam", dam_for(e, parts)});
  return cases;
}

}  // namespace moraine::test
