// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "physics/scene/scene.hpp"

namespace moraine::soft_sphere {

/// Spheres that overlap at the start are thrown apart by what their contact holds: without damping at
/// sqrt(2 U / m*), with U = k d^2 / 2 (linear) or 8/15 E* sqrt(R*) d^(5/2) (Hertz). Errors: InputError if the deepest
/// overlap makes that faster than run.max_speed or, unless stated, 10 times the speed at which elements are expected to
/// meet (typical_speed). Cost: linear in elements.
void check_start(const Scene& scene);

}  // namespace moraine::soft_sphere
