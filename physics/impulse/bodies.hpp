// SPDX-License-Identifier: Apache-2.0
// The bodies of a world as compact arrays in scaled units, ascending by id.
#pragma once

#include <vector>

#include "physics/impulse/units.hpp"
#include "physics/native/roster.hpp"

namespace moraine::impulse {

/// The first number of a list of vectors; none if that is empty.
template <class Vectors>
auto* numbers_of(Vectors& vectors) {
  return vectors.empty() ? nullptr : vectors.front().data();
}

using native::nowhere;
using native::Place;

/// What contacts change, and how easily.
struct alignas(32) Moving {
  Vec velocity = Vec::Zero();
  Vec turning = Vec::Zero();  ///< radius times angular velocity; inverse mass in the last lane

  float inverse_mass() const { return turning.w(); }
};

class Bodies {
 public:
  explicit Bodies(const Units& units) : units_(units) {}

  std::size_t size() const { return roster.size(); }
  Place place(Slot slot) const { return roster.place(slot); }
  float radius(Place p) const { return position[p].w(); }

  Slot add(const Body& body, const Shape& shape);
  void set_mass(Place p, double mass, bool bears) {
    moving[p].turning.w() = static_cast<float>(units_.mass / mass);
    carries[p] = bears;
  }
  void set_state(Place p, const ElementState& state);
  ElementState state(Place p) const { return {{units_.position(position[p]), orientation(p)}, twist(p)}; }
  Twist twist(Place p) const;
  /// A change of velocities by an impulse in SI.
  void push(Place p, const Impulse& impulse);

  /// Puts all in id order; see roster.moved().
  void settle();
  /// All fall for a step; `remember`: keeps the velocities that they had.
  void fall(const Vec& change, bool remember);
  /// Moves and turns all by their velocities over h.
  void advance(float h, bool turn);

  native::Roster roster;
  std::vector<Vec> position;  ///< radius in the last lane
  std::vector<Moving> moving;
  std::vector<std::uint32_t> material;
  std::vector<Vec> before;    ///< velocities at the start of the step, if anything rebounds
  std::vector<Vec> attitude;  ///< quaternions x, y, z, w
  std::vector<std::uint8_t> ghost;
  std::vector<std::uint8_t> carries;  ///< see Body

 private:
  Quat orientation(Place p) const;
  double si_radius(Place p) const { return static_cast<double>(radius(p)) * units_.length; }

  const Units& units_;
};

}  // namespace moraine::impulse
