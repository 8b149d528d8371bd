// SPDX-License-Identifier: Apache-2.0
// One contact as the solver sees it, and one correction of it: a soft constraint along the normal, Coulomb's disc
// across.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/impulse/units.hpp"

namespace moraine::impulse {

/// How sweeps treat overlaps.
struct Softness {
  float mass_scale = 1;
  float impulse_scale = 0;
};

/// A contact between a and b. Impulses act on a, the opposite ones on b.
struct alignas(16) ContactRow {
  Vec normal = Vec::Zero();  ///< unit, towards a
  Vec side = Vec::Zero();    ///< tangential impulse of the step so far
  float push = 0;            ///< normal impulse of the step so far, 0 or more
  /// Speed at which the surfaces may approach, so that a gap just closes; negative: at which they must part.
  float approach = 0;
  float mass = 0;  ///< reduced
  float friction = 0;
};

/// The change of a row's impulse.
struct Change {
  Vec impulse;
  Vec side;  ///< its tangential part
};

/// `slip`: velocity of a's surface relative to b's where they touch.
/// Normal: soft constraints of Catto ("Soft Constraints", GDC 2011; "Solver2D", 2024): with the natural frequency w and
/// damping ratio z of the contact, impulses change by -mass_scale m (v + bias) - impulse_scale * push. Gaps are hard.
/// Across: for two spheres (7/2 of the inverse mass resists any slip, and normal impulses make none) both parts are
/// solved from the same slip; the tangential impulse is cut to the disc of radius friction * push, the same in every
/// direction.
template <bool Friction>
Change correct(ContactRow& row, const Vec& slip, const Softness& softness) {
  const float parting = row.normal.dot(slip);
  const bool hard = row.approach >= 0;
  const float mass_scale = hard ? 1 : softness.mass_scale;
  const float impulse_scale = hard ? 0 : softness.impulse_scale;
  const float before = row.push;
  row.push = std::max(before - mass_scale * row.mass * (parting + row.approach) - impulse_scale * before, 0.0F);
  Change change{(row.push - before) * row.normal, Vec::Zero()};
  if constexpr (Friction) {
    const Vec old = row.side;
    const Vec across = slip - parting * row.normal;
    Vec wanted = old - 2.0F / 7 * row.mass * across;
    const float limit = row.friction * row.push, size2 = wanted.squaredNorm();
    if (size2 > limit * limit) wanted *= limit / std::sqrt(size2);
    row.side = wanted;
    change.side = wanted - old;
    change.impulse += change.side;
  }
  return change;
}

/// The `approach` of a row once its bodies have moved: a contact that carries parts with the speed of the rebound, one
/// that was about to close without doing so yet is left to the next step.
inline float relaxed_approach(const ContactRow& row, float rebound) {
  constexpr float free = 1e10F;
  if (row.push > 0) return -rebound;
  return row.approach > 0 ? free : 0;
}

/// Surface speed that tangential impulse `side` gives a sphere of unit mass: 5/2 side x normal.
inline Vec turn(const Vec& side, const Vec& normal) { return 2.5F * side.cross3(normal); }

}  // namespace moraine::impulse
