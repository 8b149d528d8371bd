// SPDX-License-Identifier: Apache-2.0
// The force of one contact: spring and dashpot along the normal, spring, dashpot and slider along the surface.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/soft_sphere/contact_law.hpp"
#include "physics/types.hpp"

namespace moraine::soft_sphere {

/// What a contact remembers while it lasts.
struct Springs {
  Vec3 sliding = Vec3::Zero();  ///< stretch of the tangential spring [m]
  Vec3 rolling = Vec3::Zero();  ///< of the rolling spring [m]
};

/// How two bodies meet. Motions are those of the first relative to the second.
struct Meeting {
  Vec3 normal = Vec3::UnitZ();   ///< unit, towards the first
  double overlap = 0;            ///< [m], more than 0
  Vec3 velocity = Vec3::Zero();  ///< of the centres (of the surface, for a wall) [m/s]
  Vec3 turning = Vec3::Zero();   ///< arm_1 w_1 + arm_2 w_2 [m/s]
  Vec3 spin = Vec3::Zero();      ///< w_1 - w_2 [rad/s]
  double root_mass = 0;          ///< sqrt(m*) [kg^1/2]
  double radius = 0;             ///< R* [m]
};

/// What the first body feels; the second feels the opposite force and couple, and the same turning moment.
struct Push {
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();  ///< per arm, on both bodies [N]
  Vec3 couple = Vec3::Zero();  ///< of rolling friction [N m]
};

/// Which parts of a contact a scene needs.
template <bool Hertz, bool Friction, bool Rolling>
struct Parts {
  static constexpr bool hertz = Hertz, friction = Friction, rolling = Rolling;
};

/// A spring, dashpot and slider in the tangent plane: the spring turns with the contact by losing its normal part, and
/// slips where the limit is reached (Cundall & Strack 1979, as LAMMPS gran/hooke/history).
inline Vec3 slider(Vec3& spring, const Vec3& velocity, const Vec3& normal, double stiffness, double damping,
                   double limit, double h) {
  spring += h * velocity;
  spring -= spring.dot(normal) * normal;
  Vec3 force = -stiffness * spring - damping * velocity;
  const double force2 = force.squaredNorm();
  if (force2 > limit * limit) {
    force *= limit / std::sqrt(force2);
    spring = -(force + damping * velocity) / stiffness;
  }
  return force;
}

/// Advances the springs by h and returns the push. With h = 0: the push as it is.
/// While a Mindlin contact is loaded the spring's force stays and its stiffness grows; while unloaded, the force falls
/// with the stiffness (Thornton, Cummins & Cleary 2013), so that no energy is made.
template <class Uses>
Push push(const ContactLaw& law, const Meeting& m, double h, Springs& springs) {
  const double closing = m.velocity.dot(m.normal);
  const double a = Uses::hertz ? std::sqrt(m.radius * m.overlap) : 1.0;
  const double damping = law.damping * m.root_mass * (Uses::hertz ? std::sqrt(a) : 1.0);
  const double normal_force = law.stiffness * a * m.overlap - damping * closing;
  Push out{normal_force * m.normal, Vec3::Zero(), Vec3::Zero()};
  if constexpr (!Uses::friction) return out;
  if (Uses::hertz && closing < 0 && m.overlap > 0)
    springs.sliding *= std::sqrt(std::max(0.0, m.overlap + h * closing) / m.overlap);
  const Vec3 slip = m.velocity - closing * m.normal - m.turning.cross(m.normal);
  const double stiffness = law.tangential * a, side_damping = tangential_damping * damping;
  const double load = std::abs(normal_force);
  const Vec3 side = slider(springs.sliding, slip, m.normal, stiffness, side_damping, law.friction * load, h);
  out.force += side;
  out.moment = side.cross(m.normal);
  if constexpr (Uses::rolling) {
    const Vec3 roll = m.radius * m.spin.cross(m.normal);
    out.couple = m.radius * m.normal.cross(slider(springs.rolling, roll, m.normal, stiffness, side_damping,
                                                  law.rolling * load, h));
  }
  return out;
}

/// What a tangential spring can give back [J]. While it slips it is stretched against its dashpot as well, by up to as
/// much as the slip's own energy, and that it does not give back: no more counts than friction can hold.
inline double held(const Vec3& spring, double stiffness, double limit) {
  return 0.5 * std::min(stiffness * spring.squaredNorm(), limit * limit / stiffness);
}

/// Stored in the springs of a contact [J]: k d^2 / 2, or 2/5 of it per a = sqrt(R* d) (Hertz), and what the tangential
/// springs hold. 0 if the surfaces are apart.
inline double elastic_energy(const ContactLaws& laws, const ContactLaw& law, double radius, double overlap,
                             const Springs& springs) {
  if (overlap <= 0) return 0;
  const double a = laws.hertz() ? std::sqrt(radius * overlap) : 1.0;
  const double normal = (laws.hertz() ? 0.4 : 0.5) * law.stiffness * overlap * overlap;
  const double load = law.stiffness * overlap;
  const double side = held(springs.sliding, law.tangential, law.friction * load) +
                      held(springs.rolling, law.tangential, law.rolling * load);
  return a * (normal + side);
}

/// Calls visit(Parts<...>{}) with what these laws use. Rolling friction comes with friction only.
template <class Visit>
void with_parts(const ContactLaws& laws, Visit&& visit) {
  const auto friction = [&](auto hertz) {
    constexpr bool h = decltype(hertz)::value;
    if (!laws.friction()) return visit(Parts<h, false, false>{});
    return laws.rolling() ? visit(Parts<h, true, true>{}) : visit(Parts<h, true, false>{});
  };
  return laws.hertz() ? friction(std::true_type{}) : friction(std::false_type{});
}

}  // namespace moraine::soft_sphere
