// SPDX-License-Identifier: Apache-2.0
// How many sub-models a scene is cut into when it does not say.
#pragma once

#include "physics/scene/scene.hpp"
#include "physics/world.hpp"

namespace moraine {

/// Ghosts per element of a compact sub-model of n elements: about three of its six faces are hosted, a face of a packed
/// block of n spheres has n^(2/3) of them. Compared with measured shares in docs/accuracy.md.
double expected_ghost_share(double elements);

/// Elements per sub-model at which measured engine cost times (1 + ghost share) is least, among those with at most a
/// third of ghosts.
double cheapest_size(const Engine& engine);

/// Sub-models for a scene of `elements`: its size over the cheapest one, more if the engine's limits ask for it.
/// Depends on scene and engine only, never on cores or ranks.
std::size_t auto_count(std::size_t elements, const Engine& engine, const Limits& limits);

}  // namespace moraine
