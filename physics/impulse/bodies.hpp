// SPDX-License-Identifier: Apache-2.0
// The bodies of a world as compact arrays in scaled units, ascending by id.
#pragma once

#include <vector>

#include "physics/impulse/units.hpp"
#include "physics/native/roster.hpp"

namespace moraine::impulse {

using native::nowhere;
using native::Place;

/// What contacts change.
struct alignas(32) Moving {
  Vec velocity = Vec::Zero();
  Vec turning = Vec::Zero();  ///< radius times angular velocity
};

/// What contacts ask for besides.
struct Weight {
  float inverse_mass = 0;
  std::uint32_t material = 0;
};

class Bodies {
 public:
  explicit Bodies(const Units& units) : units_(units) {}

  std::size_t size() const { return roster.size(); }
  Place place(Slot slot) const { return roster.place(slot); }
  float radius(Place p) const { return position[p].w(); }

  Slot add(const Body& body, const Shape& shape);
  void set_mass(Place p, double mass) { weight[p].inverse_mass = static_cast<float>(units_.mass / mass); }
  void set_state(Place p, const ElementState& state);
  ElementState state(Place p) const { return {{units_.position(position[p]), orientation(p)}, twist(p)}; }
  Twist twist(Place p) const;
  /// Other worlds hold copies of it.
  bool shared(Place p) const { return ghost[p] || weight[p].inverse_mass > whole[p]; }
  /// A change of velocities by an impulse in SI.
  void push(Place p, const Impulse& impulse);

  /// Puts all in id order; see roster.moved().
  void settle();
  /// Moves and turns all by their velocities over h.
  void advance(float h, bool turn);

  native::Roster roster;
  std::vector<Vec> position;  ///< radius in the last lane
  std::vector<Moving> moving;
  std::vector<Weight> weight;
  std::vector<Vec> attitude;  ///< quaternions x, y, z, w
  std::vector<std::uint8_t> ghost;
  std::vector<float> whole;  ///< inverse mass when added

 private:
  Quat orientation(Place p) const;
  double si_radius(Place p) const { return static_cast<double>(radius(p)) * units_.length; }

  const Units& units_;
};

}  // namespace moraine::impulse
