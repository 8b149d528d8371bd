// SPDX-License-Identifier: Apache-2.0
// Bullet's rows in the table of engines.
#pragma once

#include "physics/world.hpp"

namespace moraine::bullet {

Engine float32_engine();
Engine float64_engine();

}  // namespace moraine::bullet
