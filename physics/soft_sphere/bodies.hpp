// SPDX-License-Identifier: Apache-2.0
// The bodies of a world as compact arrays, ascending by id, so that going through the arrays is going in id order.
#pragma once

#include <span>
#include <vector>

#include "physics/native/sized_grid.hpp"
#include "physics/world.hpp"

namespace moraine::soft_sphere {

/// A body's index into the arrays; changes when bodies come and go.
using Place = std::uint32_t;
inline constexpr Place nowhere = ~Place{0};

/// What a contact reads besides the ball: one cache line.
struct alignas(64) Moving {
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  double inverse_mass = 0;
  std::uint32_t material = 0;
};

struct Load {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};

class Bodies {
 public:
  struct Entry {
    ElementId id = 0;
    Slot slot = 0;
    std::uint32_t shape = 0;
    double mass = 0;
  };

  std::size_t size() const { return entries.size(); }
  std::size_t count() const { return entries.size() - gone_; }
  Place place(Slot slot) const { return places_[slot]; }
  /// The place of the body with this id among settled ones, or nowhere. Cost: log n.
  Place find(ElementId id) const;

  Slot add(const Body& body, const Shape& shape);
  void remove(Slot slot);
  /// Another mass than before makes the bodies unsettled: what is known of pairs depends on it.
  void set_mass(Place place, double mass);
  void set_state(Place place, const ElementState& state);
  ElementState state(Place place) const;

  /// Bodies came or went since settle().
  bool unsettled() const { return unsettled_; }
  /// Closes gaps and puts newcomers in their places. Returns the new place of every old one, or nowhere.
  const std::vector<Place>& settle();
  void clear();

  const std::vector<Slot>& free_slots() const { return free_; }
  std::size_t slots() const { return places_.size(); }
  /// For a saved world: the arrays hold settled bodies, the slots that are not theirs are `free`.
  void restore_slots(std::size_t slots, std::vector<Slot> free);

  /// Angular velocity per angular impulse of a solid sphere [1/(kg m^2)].
  double inverse_inertia(Place p) const { return 2.5 * moving[p].inverse_mass / (ball[p].radius * ball[p].radius); }

  std::vector<Entry> entries;
  std::vector<std::uint8_t> ghost;
  std::vector<Vec3> position;  ///< at the ends of substeps
  std::vector<Quat> orientation;
  std::vector<Moving> moving;
  std::vector<native::Ball> ball;  ///< where forces act: in the middle of the substep
  std::vector<Load> load;

 private:
  void resize(std::size_t size);

  std::vector<Place> places_;  ///< by slot
  std::vector<Slot> free_;
  std::vector<std::uint8_t> removed_;
  std::size_t gone_ = 0;
  bool unsettled_ = false;
  std::vector<Place> order_, moved_;
};

}  // namespace moraine::soft_sphere
