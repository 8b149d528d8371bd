// SPDX-License-Identifier: Apache-2.0
// ODE's row in the table of engines.
#pragma once

#include "physics/world.hpp"

namespace moraine::ode {

Engine engine();

}  // namespace moraine::ode
