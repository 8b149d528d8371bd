// SPDX-License-Identifier: Apache-2.0
// One contact as the solver sees it, and one correction of it: a soft constraint along the normal, Coulomb's disc
// across.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/impulse/units.hpp"

namespace moraine::impulse {

/// A contact between a and b. Impulses act on a, the opposite ones on b.
struct alignas(16) ContactRow {
  Vec normal = Vec::Zero();  ///< unit, towards a
  Vec side = Vec::Zero();    ///< tangential impulse of the step so far
  float push = 0;            ///< normal impulse of the step so far, 0 or more
  /// Speed at which the surfaces may approach, so that a gap just closes; negative: at which they must part.
  float approach = 0;
  float mass = 0;  ///< reduced
  float friction = 0;
  float firmness = 0;  ///< impulse per speed; the mass if the contact is hard
  float yielding = 0;  ///< share of the impulse that is given up per sweep; 0 if the contact is hard
  float rebound = 0;   ///< speed after an impact
  float gap = 0;       ///< negative: overlap
};

/// The change of a row's impulse.
struct Change {
  Vec impulse;
  Vec side;  ///< its tangential part
};

/// `slip`: velocity of a's surface relative to b's where they touch.
/// Normal: soft constraint (Catto, "Soft Constraints", GDC 2011; "Solver2D", 2024).
/// Across: two spheres resist slip with 7/2 of their inverse masses in any direction, and normal impulses make none, so
/// both parts are solved from the same slip; the tangential impulse is cut to the disc of radius friction * push.
template <bool Friction>
Change correct(ContactRow& row, const Vec& slip) {
  const float parting = row.normal.dot(slip);
  const float before = row.push;
  row.push = positive(before - row.firmness * (parting + row.approach) - row.yielding * before);
  Change change{(row.push - before) * row.normal, Vec::Zero()};
  if constexpr (Friction) {
    const Vec old = row.side;
    const Vec across = slip - parting * row.normal;
    const Vec wanted = old - 2.0F / 7 * row.mass * across;
    constexpr float tiny = 1e-30F;
    const float limit = row.friction * row.push, size2 = larger(wanted.squaredNorm(), tiny);
    row.side = limit / std::sqrt(larger(size2, limit * limit)) * wanted;
    change.side = row.side - old;
    change.impulse += change.side;
  }
  return change;
}

/// Once bodies have moved: a contact that carries parts with the speed of the rebound, one that was about to close
/// without doing so yet is left to the next step.
inline void relax(ContactRow& row) {
  constexpr float free = 1e10F;
  row.approach = row.push > 0 ? -row.rebound : row.gap > 0 ? free : 0;
  row.firmness = row.mass;
  row.yielding = 0;
}

/// Surface speed that tangential impulse `side` gives a sphere of unit mass: 5/2 side x normal.
inline Vec turn(const Vec& side, const Vec& normal) { return 2.5F * side.cross3(normal); }

}  // namespace moraine::impulse
