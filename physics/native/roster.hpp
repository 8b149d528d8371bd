// SPDX-License-Identifier: Apache-2.0
// Who is in a world and where: slots for the outside, places in compact arrays, ascending by id, for the inside.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "physics/bytes.hpp"
#include "physics/world.hpp"

namespace moraine::native {

/// A body's index into the arrays of a world; changes when bodies come and go.
using Place = std::uint32_t;
inline constexpr Place nowhere = ~Place{0};

/// Newcomers take the last place until settle() puts all in id order.
class Roster {
 public:
  struct Member {
    ElementId id = 0;
    Slot slot = 0;
  };

  /// Places in use, those of removed bodies included until settle().
  std::size_t size() const { return members_.size(); }
  std::size_t count() const { return members_.size() - gone_; }
  Place place(Slot slot) const { return places_[slot]; }
  ElementId id(Place place) const { return members_[place].id; }
  std::span<const Member> members() const { return members_; }

  Slot add(ElementId id);
  void remove(Slot slot);

  bool unsettled() const { return unsettled_; }
  /// How many were there when places were last put in order; newcomers have later places.
  std::size_t settled() const { return settled_; }
  /// Closes gaps and sorts newcomers in. Afterwards order() has the old place of every new one, moved() the new place
  /// of every old one, or nowhere. Cost: n, and m log m for m newcomers.
  void settle();
  const std::vector<Place>& order() const { return order_; }
  const std::vector<Place>& moved() const { return moved_; }

  // For a saved world, of settled bodies.
  std::size_t slots() const { return places_.size(); }
  const std::vector<Slot>& free_slots() const { return free_; }
  void restore(std::vector<Member> members, std::size_t slots, std::vector<Slot> free);
  void save(ByteWriter& w) const;
  void load(ByteReader& r);

 private:
  std::vector<Member> members_;
  std::vector<Place> places_;  ///< by slot
  std::vector<Slot> free_;
  std::vector<std::uint8_t> removed_;
  std::size_t gone_ = 0;
  std::size_t settled_ = 0;
  bool unsettled_ = false;
  std::vector<Place> order_, moved_, arrivals_;
};

/// Puts values that stood at the old places `order` in this order. Buffers are kept by the thread.
template <class T>
void reorder(std::vector<T>& values, std::span<const Place> order) {
  if (values.size() == order.size() && std::is_sorted(order.begin(), order.end())) return;
  thread_local std::vector<T> sorted;
  sorted.clear();
  for (const Place p : order) sorted.push_back(values[p]);
  values.assign(sorted.begin(), sorted.end());
}

}  // namespace moraine::native
