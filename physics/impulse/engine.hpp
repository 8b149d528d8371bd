// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "physics/world.hpp"

namespace moraine::impulse {

/// The row of the engine table.
Engine engine();

}  // namespace moraine::impulse
