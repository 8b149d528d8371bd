// SPDX-License-Identifier: Apache-2.0
// Between SI in the world frame and the scaled, local numbers that ODE sees.
#pragma once

#include <ode/ode.h>

#include "physics/types.hpp"
#include "physics/world.hpp"

namespace moraine::ode {

static_assert(sizeof(dReal) == sizeof(double), "Debian builds ODE in double precision");

inline Vec3 vec(const dReal* v) { return {v[0], v[1], v[2]}; }

/// A typical element has diameter 1 and mass 1, and falls its own diameter in
/// about one unit of time: ODE's settings and its tolerances mean the same at
/// every scale. Positions are relative to the world's origin.
class Units {
 public:
  Units(const WorldSettings& s, const Vec3& origin)
      : length(s.length_unit), time(s.time_unit), mass(s.mass_unit), origin_(origin) {}

  const double length, time, mass;
  double velocity() const { return length / time; }
  double momentum() const { return mass * length / time; }

  Vec3 position(const Vec3& p) const { return (p - origin_) / length; }
  Vec3 world(const Vec3& p) const { return origin_ + length * p; }

 private:
  Vec3 origin_;
};

}  // namespace moraine::ode
