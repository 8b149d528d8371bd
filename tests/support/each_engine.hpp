// SPDX-License-Identifier: Apache-2.0
// The same little scene for every engine in the table.
#pragma once

#include <algorithm>

#include "tests/support/model_run.hpp"

namespace moraine::test {

/// A dam of 300 spheres in `parts` sub-models for 0.3 s, in steps that the engine can take.
inline std::vector<Override> dam_for(const Engine& engine, int parts) {
  std::vector<Override> out{set("count", 300), set("time.duration", 0.3), set("run.sub_models", parts),
                            set("run.engine", std::string(engine.name)), set("materials.grain.restitution", 0.5)};
  const Scene scene = example("dam", out);
  out.push_back(set("time.dt", std::min(scene.time.dt, 0.8 * engine.step_limit(scene).substep)));
  return out;
}

/// Cases{name, scene, overrides} for all engines.
template <class Case>
std::vector<Case> with_every_engine(std::vector<Case> cases, int parts) {
  for (const Engine& e : engines()) cases.push_back({"dam_" + std::string(e.name), "dam", dam_for(e, parts)});
  return cases;
}

}  // namespace moraine::test
