// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "physics/world.hpp"

namespace moraine::soft_sphere {

/// The largest substep with which no part of the scene can gain energy by the time step alone, the least of
/// - springs and dashpots: the highest frequency w and damping rate D of an element among twelve like it, all contacts
///   closed and sticking, plus its bonds, bound a substep to (sqrt(D^2 + 4 w^2) - D) / w^2 (root of the leapfrog's
///   characteristic equation with velocities half a step behind). For contacts, with the reduced mass m*:
///   w^2 = (4 k_n + 8 k_t) / m*, or 20 k_t / m* for rotations, since unit vectors to twelve close-packed neighbours
///   have the moment 4 I, the tangents 8 I. For bonds the sum of k / m* over the dyads of their directions;
/// - Hertz contacts: the same with the stiffness at the largest overlap of an impact with the typical speed, and a
/// fifth
///   of the time that a Rayleigh wave takes through the element, pi r sqrt(rho / G) / (0.1631 nu + 0.8766) (Li et al.
///   2005).
/// Cost: linear in elements and bonds.
StepLimit step_limit(const Scene& scene);

}  // namespace moraine::soft_sphere
