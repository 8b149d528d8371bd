// SPDX-License-Identifier: Apache-2.0
// One number for the state of all elements.
#pragma once

#include <cstdint>
#include <span>

#include "physics/scene/scene.hpp"

namespace moraine {

/// XXH3-64 over id, position, orientation (w x y z), velocity, angular velocity, as doubles, elements ascending by id.
std::uint64_t state_hash(const Scene& scene, std::span<const ElementState> states);

}  // namespace moraine
