// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/step_limit.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "physics/scene/bonds.hpp"
#include "physics/soft_sphere/contact_law.hpp"

namespace moraine::soft_sphere {
namespace {

using Mat3 = Eigen::Matrix3d;

constexpr double rayleigh_share = 0.2;

/// Squared frequency [1/s^2] and damping rate [1/s] of what holds an element.
struct Stiffness {
  double frequency2 = 0;
  double damping = 0;

  Stiffness operator+(const Stiffness& o) const { return {frequency2 + o.frequency2, damping + o.damping}; }
  double largest_step() const {
    if (frequency2 <= 0) return damping > 0 ? 2 / damping : std::numeric_limits<double>::infinity();
    return (std::sqrt(damping * damping + 4 * frequency2) - damping) / frequency2;
  }
};

/// Bonds of every element: sum over bonds of stiffness / m* (and damping / m*) times the dyad of the direction.
struct BondTensors {
  std::vector<Mat3> stiffness, damping;

  explicit BondTensors(const Scene& scene)
      : stiffness(scene.bonds.empty() ? 0 : scene.elements.size(), Mat3::Zero()), damping(stiffness) {
    for (const Bond& b : scene.bonds) {
      const Element *first = find_element(scene.elements, b.a), *second = find_element(scene.elements, b.b);
      const Vec3 axis = (second->state.pose.position - first->state.pose.position).normalized();
      const Mat3 dyad = (1 / first->mass + 1 / second->mass) * axis * axis.transpose();
      for (const Element* e : {first, second}) {
        const auto at = static_cast<std::size_t>(e - scene.elements.data());
        stiffness[at] += b.stiffness * dyad;
        damping[at] += b.damping * dyad;
      }
    }
  }
  Stiffness of(std::size_t element) const {
    if (stiffness.empty()) return {};
    return {largest(stiffness[element]), largest(damping[element])};
  }
  static double largest(const Mat3& m) {
    return Eigen::SelfAdjointEigenSolver<Mat3>(m, Eigen::EigenvaluesOnly).eigenvalues()[2];
  }
};

/// Stiffness law k a d with a = sqrt(R* d) takes up the energy m* v^2 / 2 at d^(5/2) = 5/4 m* v^2 / (k sqrt(R*)).
double hertz_factor(const ContactLaw& law, double mass, double radius, double speed) {
  const double overlap = std::pow(1.25 * mass * speed * speed / (law.stiffness * std::sqrt(radius)), 0.4);
  return std::sqrt(radius * overlap);
}

/// Of an element among twelve like it: translation and rotation.
std::array<Stiffness, 2> contact_stiffness(const ContactLaws& laws, const ContactLaw& law, double mass, double radius,
                                           double speed) {
  const double reduced = mass / 2;
  const double a = laws.hertz() ? hertz_factor(law, reduced, radius / 2, speed) : 1;
  const double normal = (laws.hertz() ? 1.5 : 1.0) * law.stiffness * a / reduced;
  const double drag = law.damping * std::sqrt(a / reduced);
  if (law.friction <= 0) return {Stiffness{4 * normal, 4 * drag}, Stiffness{}};
  const double side = law.tangential * a / reduced, side_drag = tangential_damping * drag;
  return {Stiffness{4 * normal + 8 * side, 4 * drag + 8 * side_drag}, Stiffness{20 * side, 20 * side_drag}};
}

double rayleigh_time(const Material& m, double mass, double radius) {
  const double density = mass / (4.0 / 3 * std::numbers::pi * radius * radius * radius);
  const double shear = m.young / (2 * (1 + m.poisson));
  return std::numbers::pi * radius * std::sqrt(density / shear) / (0.1631 * m.poisson + 0.8766);
}

void tighten(StepLimit& limit, double substep, const char* what, ElementId id) {
  if (substep >= limit.substep) return;
  limit = {substep, fmt::format("{} of element {}", what, id)};
}

}  // namespace

StepLimit step_limit(const Scene& scene) {
  const ContactLaws laws(scene);
  const BondTensors bonds(scene);
  const double speed = typical_speed(scene);
  StepLimit limit;
  for (std::size_t i = 0; i < scene.elements.size(); ++i) {
    const Element& e = scene.elements[i];
    const double radius = scene.shape_of(e).bounding_radius;
    const Stiffness held = bonds.of(i);
    tighten(limit, held.largest_step(), "bonds", e.id);
    for (std::uint32_t other = 0; other < laws.materials(); ++other)
      for (const Stiffness& s : contact_stiffness(laws, laws.of(e.material, other), e.mass, radius, speed))
        tighten(limit, (s + held).largest_step(), held.largest_step() < s.largest_step() ? "bonds" : "contacts", e.id);
    if (laws.hertz())
      tighten(limit, rayleigh_share * rayleigh_time(scene.materials.materials[e.material], e.mass, radius),
              "the Rayleigh wave", e.id);
  }
  return limit;
}

}  // namespace moraine::soft_sphere
