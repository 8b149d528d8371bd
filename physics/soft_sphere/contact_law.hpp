// SPDX-License-Identifier: Apache-2.0
// How two materials push and rub: the constants of a contact, from the scene.
#pragma once

#include <vector>

#include "physics/scene/scene.hpp"

namespace moraine::soft_sphere {

/// Constants of contacts between two materials. With R* and m* the reduced radius and mass, d the overlap, and
/// a = 1 (linear) or sqrt(R* d) (Hertz-Mindlin):
///   normal force      stiffness a d   (Hertz: 4/3 E* a d)   - damping sqrt(a m*) dd/dt
///   tangential spring tangential a    (Mindlin: 8 G* a)     with half the normal damping
struct ContactLaw {
  double stiffness = 0;
  double tangential = 0;
  double damping = 0;
  double friction = 0;  ///< Coulomb coefficient
  double rolling = 0;   ///< coefficient of rolling friction: torque / (normal force R*)
};

/// Ratio of tangential to normal damping: the default of LAMMPS gran/hooke/history.
inline constexpr double tangential_damping = 0.5;

/// One law per pair of materials.
class ContactLaws {
 public:
  explicit ContactLaws(const Scene& scene);

  const ContactLaw& of(std::uint32_t a, std::uint32_t b) const { return laws_[a * count_ + b]; }
  std::size_t materials() const { return count_; }
  bool hertz() const { return hertz_; }
  bool friction() const { return friction_; }
  bool rolling() const { return rolling_; }

 private:
  std::size_t count_ = 0;
  std::vector<ContactLaw> laws_;
  bool hertz_ = false, friction_ = false, rolling_ = false;
};

/// Damping ratio of a linear spring and dashpot that returns the share `restitution` of the speed of an impact:
/// -ln e / sqrt(pi^2 + ln^2 e). 1 (critical) for e = 0, where the formula tends to. The dashpot of a Hertz contact,
/// proportional to overlap^(1/4), returns the same share (Antypov & Elliott 2011).
double damping_ratio(double restitution);

/// Speed at which elements are expected to meet: sqrt(g d) under gravity, else the fastest that anything moves at the
/// start or is driven [m/s].
double typical_speed(const Scene& scene);

}  // namespace moraine::soft_sphere
