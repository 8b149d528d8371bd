// SPDX-License-Identifier: Apache-2.0
// The section `perturbation`: small random speeds at the start, so that runs of one scene can be told apart by a seed.
#include "physics/scene/draft.hpp"
#include "physics/scene/random.hpp"

namespace moraine {

void read_perturbation(const Node& root, Scene& scene) {
  const auto node = root.find("perturbation");
  if (!node) return;
  node->allow({"speed", "seed"});
  Perturbation& p = scene.perturbation;
  p.speed = node->at("speed", "the standard deviation of each velocity component [m/s]").not_negative();
  p.seed = static_cast<std::uint64_t>(node->integer("seed", 1, 0));
  for (Element& e : scene.elements)
    for (int axis = 0; axis < 3; ++axis)
      e.state.twist.linear[axis] += p.speed * normal_of(p.seed, e.id, static_cast<std::uint32_t>(axis));
}

}  // namespace moraine
