// SPDX-License-Identifier: Apache-2.0
// Momentum and energy accounts: what the elements have, and what gravity and boundaries gave them.
#pragma once

#include "physics/types.hpp"

namespace moraine {

/// Sums over a sub-model's own elements; angular parts about the world origin.
struct Ledger {
  Impulse momentum;                     ///< now [kg m/s, kg m^2/s]
  Impulse given;                        ///< by gravity and boundaries since the start
  double exchanged = 0;                 ///< sum of the magnitudes of what was given, linear [N s]
  double exchanged_angular = 0;         ///< the same, angular [N m s]
  Vec3 from_boundaries = Vec3::Zero();  ///< linear part of `given` that is not gravity's [N s]
  double work = 0;                      ///< that driven boundaries did since the start [J]
  double kinetic_energy = 0;            ///< now [J]
  double potential_energy = 0;          ///< now, under gravity; 0 at the world origin [J]
  double bond_energy = 0;               ///< now, elastic [J]
  double contact_energy = 0;            ///< now, elastic; of engines whose contacts are springs [J]
  double speed_sum = 0;                 ///< sum of m |v| now
  double spin_scale = 0;                ///< sum of |m x cross v| + |I w| now
  Vec3 mass_moment = Vec3::Zero();      ///< sum of m x now
  double mass = 0;

  double energy() const { return kinetic_energy + potential_energy + bond_energy + contact_energy; }
  Ledger& operator+=(const Ledger& o) {
    momentum += o.momentum;
    given += o.given;
    exchanged += o.exchanged;
    exchanged_angular += o.exchanged_angular;
    from_boundaries += o.from_boundaries;
    work += o.work;
    kinetic_energy += o.kinetic_energy;
    potential_energy += o.potential_energy;
    bond_energy += o.bond_energy;
    contact_energy += o.contact_energy;
    speed_sum += o.speed_sum;
    spin_scale += o.spin_scale;
    mass_moment += o.mass_moment;
    mass += o.mass;
    return *this;
  }
};

}  // namespace moraine
