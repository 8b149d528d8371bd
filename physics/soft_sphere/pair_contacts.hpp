// SPDX-License-Identifier: Apache-2.0
// Contacts between two balls.
#pragma once

#include "physics/native/verlet_list.hpp"
#include "physics/soft_sphere/bodies.hpp"
#include "physics/soft_sphere/contact_force.hpp"

namespace moraine::soft_sphere {

/// A contact that lasts, between two places.
struct LastingPair {
  Place low = 0, high = 0;
  Springs springs;
};

/// Every pair's force is worked out once, from its lower to its higher id, and added in the order of the list: a body
/// sums what its partners do to it in ascending order of their ids, whatever else is in the world.
class PairContacts {
 public:
  explicit PairContacts(const ContactLaws& laws) : laws_(laws) {}

  /// Lists the pairs anew. Contacts in `lasting` go on where they were; all others are forgotten.
  void list(const native::SizedGrid& grid, const Bodies& bodies, double skin, std::span<const LastingPair> lasting);
  /// Contacts of the last step, ascending.
  void lasting(std::vector<LastingPair>& out) const;

  /// Adds all forces to the loads and advances the springs by h. Cost: linear in listed pairs.
  void act(Bodies& bodies, double h);
  std::size_t count() const { return touching_.size(); }
  /// Elastic energy with the positions of now, half of it where a body is a ghost [J].
  double energy(const Bodies& bodies) const;
  /// Calls visit(low, high, meeting, push) for every contact of the last step, ascending, with the velocities of now.
  template <class Visit>
  void each(const Bodies& bodies, Visit&& visit) const;

 private:
  void find_touching(const Bodies& bodies);
  template <class Uses>
  void act_on_touching(Bodies& bodies, double h);
  static Meeting meet(const Bodies& bodies, Place i, Place j, double root_mass, double& arm_i, double& arm_j);
  Springs springs(std::size_t pair) const;

  const ContactLaws& laws_;
  native::VerletList pairs_;
  std::vector<std::uint8_t> open_;       ///< by pair: touched in the last step
  std::vector<double> root_mass_;        ///< by pair: sqrt(m*) [kg^1/2]
  std::vector<Vec3> sliding_, rolling_;  ///< by pair; as far as the laws need them
  std::vector<std::uint32_t> touching_;  ///< pairs, ascending
};

inline Meeting PairContacts::meet(const Bodies& bodies, Place i, Place j, double root_mass, double& arm_i,
                                  double& arm_j) {
  const native::Ball &a = bodies.ball[i], &b = bodies.ball[j];
  const Moving &p = bodies.moving[i], &q = bodies.moving[j];
  const Vec3 between = a.centre - b.centre;
  const double distance = between.norm();
  Meeting m;
  if (distance > 0) m.normal = (1 / distance) * between;
  m.overlap = a.radius + b.radius - distance;
  arm_i = a.radius - 0.5 * m.overlap;
  arm_j = b.radius - 0.5 * m.overlap;
  m.velocity = p.velocity - q.velocity;
  m.turning = arm_i * p.spin + arm_j * q.spin;
  m.spin = p.spin - q.spin;
  m.root_mass = root_mass;
  m.radius = a.radius * b.radius / (a.radius + b.radius);
  return m;
}

template <class Visit>
void PairContacts::each(const Bodies& bodies, Visit&& visit) const {
  with_parts(laws_, [&](auto parts) {
    for (const std::uint32_t k : touching_) {
      const Place i = pairs_.lower()[k], j = pairs_.higher()[k];
      double arm_i = 0, arm_j = 0;
      const Meeting m = meet(bodies, i, j, root_mass_[k], arm_i, arm_j);
      Springs s = springs(k);
      visit(i, j, m, push<decltype(parts)>(laws_.of(bodies.moving[i].material, bodies.moving[j].material), m, 0, s));
    }
  });
}

}  // namespace moraine::soft_sphere
