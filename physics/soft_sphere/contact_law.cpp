// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/contact_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/errors.hpp"

namespace moraine::soft_sphere {
namespace {

constexpr double stiffness_default = 5e4;         ///< in typical mass * speed^2 / diameter^2: m g / d under gravity
constexpr double tangential_ratio = 2.0 / 7;      ///< of normal stiffness: both springs swing in equal time
constexpr double diameters_per_step_rest = 1e-3;  ///< where nothing moves and nothing falls

double default_stiffness(const Scene& scene) {
  const double d = scene.typical_diameter(), v = typical_speed(scene);
  return stiffness_default * scene.typical_mass() * v * v / (d * d);
}

ContactLaw linear(const Material& a, const Material& b, double fallback) {
  const double ka = a.normal_stiffness > 0 ? a.normal_stiffness : fallback;
  const double kb = b.normal_stiffness > 0 ? b.normal_stiffness : fallback;
  ContactLaw law;
  law.stiffness = 2 * ka * kb / (ka + kb);
  law.tangential = tangential_ratio * law.stiffness;
  law.damping = 2 * std::sqrt(law.stiffness);
  return law;
}

double compliance(const Material& m) { return (1 - m.poisson * m.poisson) / m.young; }
double shear_compliance(const Material& m) { return 2 * (2 - m.poisson) * (1 + m.poisson) / m.young; }

/// Hertz (1882), Mindlin (1949); damping after Tsuji et al. (1992): 2 sqrt(5/6) zeta sqrt(m* 2 E* a).
ContactLaw hertz_mindlin(const Material& a, const Material& b) {
  const double modulus = 1 / (compliance(a) + compliance(b));
  ContactLaw law;
  law.stiffness = 4.0 / 3 * modulus;
  law.tangential = 8 / (shear_compliance(a) + shear_compliance(b));
  law.damping = 2 * std::sqrt(5.0 / 6) * std::sqrt(2 * modulus);
  return law;
}

/// Errors: InputError if some materials state a modulus and others do not.
bool uses_hertz(const Scene& scene) {
  const auto& all = scene.materials.materials;
  const auto stated = std::count_if(all.begin(), all.end(), [](const Material& m) { return m.young > 0; });
  if (stated > 0 && static_cast<std::size_t>(stated) < all.size())
    throw InputError(fmt::format("{}: {} of {} materials state 'young', expected all or none of them", scene.source,
                                 stated, all.size()));
  return stated > 0;
}

}  // namespace

double damping_ratio(double restitution) {
  if (restitution <= 0) return 1;
  const double log = std::log(restitution);
  return -log / std::sqrt(std::numbers::pi * std::numbers::pi + log * log);
}

double typical_speed(const Scene& scene) {
  const double d = scene.typical_diameter();
  const double g = scene.gravity.norm();
  if (g > 0) return std::sqrt(g * d);
  double fastest = 0;
  for (const Element& e : scene.elements) fastest = std::max(fastest, e.state.twist.linear.norm());
  for (const Boundary& b : scene.boundaries) fastest = std::max(fastest, b.motion.velocity.linear.norm());
  return fastest > 0 ? fastest : diameters_per_step_rest * d / scene.time.substep();
}

ContactLaws::ContactLaws(const Scene& scene) : count_(scene.materials.materials.size()), hertz_(uses_hertz(scene)) {
  const double fallback = default_stiffness(scene);
  for (std::uint32_t a = 0; a < count_; ++a)
    for (std::uint32_t b = 0; b < count_; ++b) {
      const Material &first = scene.materials.materials[a], &second = scene.materials.materials[b];
      const PairLaw& pair = scene.materials.pair(a, b);
      ContactLaw law = hertz_ ? hertz_mindlin(first, second) : linear(first, second, fallback);
      law.damping *= damping_ratio(pair.restitution);
      law.friction = pair.friction;
      law.rolling = pair.rolling_friction;
      friction_ = friction_ || law.friction > 0;
      rolling_ = rolling_ || law.rolling > 0;
      laws_.push_back(law);
    }
}

}  // namespace moraine::soft_sphere
