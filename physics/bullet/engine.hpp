// SPDX-License-Identifier: Apache-2.0
// Bullet's row in the table of engines.
#pragma once

#include "physics/world.hpp"

namespace moraine::bullet {

Engine engine();

}  // namespace moraine::bullet
