// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "physics/world.hpp"

namespace moraine {

/// For engines that solve contacts by impulses, stable at any step: the substep up to which they are right, the least
/// of
/// - sqrt(d / g) / 20 of the smallest element, d its bounding diameter: falling for that long it gets 1/400 of d ahead;
/// - sqrt(m* / k) / 2 of the stiffest bond: beyond, bonds are integrated implicitly, with numerical damping.
/// Cost: linear in elements and bonds.
StepLimit impulse_step_advice(const Scene& scene);

}  // namespace moraine
