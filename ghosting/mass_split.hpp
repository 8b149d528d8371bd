// SPDX-License-Identifier: Apache-2.0
// Which copies of an element have its mass: those that meet something. The mass of others would be missing in impacts.
#pragma once

#include <vector>

#include "ghosting/coupling.hpp"

namespace moraine {

/// It touches something, is about to, or was pushed of late.
bool busy(const Copy& copy);

/// Splits the mass evenly among the busy copies; if there are none, the real one has it (mass splitting: Tonge et al.
/// 2012, "Mass Splitting for Jitter-Free Parallel Rigid Body Simulation", with the number of worlds in place of the
/// number of contacts). The others keep a thousandth each, for engines know no bodies without mass. What they carry
/// goes to those that have the mass, and one that has it alone carries nothing. The sum of share times offset stays
/// what it was.
void split_mass(std::vector<Copy>& copies, SubModelId owner);

/// Takes note whether a copy was pushed in a substep: by `push`, its change of velocity beyond that by gravity [m/s].
void note_push(Copy& copy, double push, double speed, double gravity_step);

}  // namespace moraine
