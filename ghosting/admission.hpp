// SPDX-License-Identifier: Apache-2.0
// What must hold before a scene may run: limits of engines, and limits that follow from the scene.
#pragma once

#include <string_view>

#include "physics/world.hpp"

namespace moraine {

/// Limits by profile name ("default", "physx"). Errors: InputError.
Limits find_limits(std::string_view profile);
/// Errors: InputError for what the engine cannot do: shapes, bonds, a substep above its limit, or as it says itself.
void check_engine(const Scene& scene, const Engine& engine);
/// How many sub-models the scene is cut into. Errors: InputError if the limits do not allow it.
std::size_t part_count(const Scene& scene, const Engine& engine, const Limits& limits);
/// The fastest that a boundary which moves between `from` and `to` [s] ever is within the box [m/s].
double driven_speed(const Scene& scene, const Bounds& box, double from, double to);
/// Nothing in the scene can get this fast: ten times the speed of falling through the whole scene, boundaries included,
/// added to what moves at the start or is driven [m/s].
double runaway_speed(const Scene& scene);

}  // namespace moraine
