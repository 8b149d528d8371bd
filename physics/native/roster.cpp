// SPDX-License-Identifier: Apache-2.0
#include "physics/native/roster.hpp"

#include <algorithm>

#include "physics/native/room.hpp"

namespace moraine::native {

Slot Roster::add(ElementId id) {
  if (free_.empty()) {
    free_.push_back(static_cast<Slot>(places_.size()));
    append(places_, nowhere);
  }
  const Slot slot = free_.back();
  free_.pop_back();
  places_[slot] = static_cast<Place>(size());
  append(members_, {id, slot});
  append(removed_, std::uint8_t{0});
  unsettled_ = true;
  return slot;
}

void Roster::remove(Slot slot) {
  removed_[places_[slot]] = 1;
  places_[slot] = nowhere;
  free_.push_back(slot);
  ++gone_;
  unsettled_ = true;
}

void Roster::settle() {
  arrivals_.clear();
  make_room(arrivals_, size());
  for (Place p = 0; p < size(); ++p)
    if (!removed_[p]) arrivals_.push_back(p);
  const auto by_id = [&](Place a, Place b) { return id(a) < id(b); };
  // Those that were here before are in order.
  const auto first = std::lower_bound(arrivals_.begin(), arrivals_.end(), settled_);
  std::sort(first, arrivals_.end(), by_id);
  make_room(order_, arrivals_.size());
  order_.resize(arrivals_.size());
  std::merge(arrivals_.begin(), first, first, arrivals_.end(), order_.begin(), by_id);
  moved_.assign(size(), nowhere);
  for (Place p = 0; p < order_.size(); ++p) moved_[order_[p]] = p;
  reorder(members_, order_);
  removed_.assign(size(), 0);
  for (Place p = 0; p < size(); ++p) places_[members_[p].slot] = p;
  gone_ = 0;
  settled_ = size();
  unsettled_ = false;
}

void Roster::restore(std::vector<Member> members, std::size_t slots, std::vector<Slot> free) {
  members_ = std::move(members);
  free_ = std::move(free);
  removed_.assign(size(), 0);
  gone_ = 0;
  settled_ = size();
  unsettled_ = false;
  places_.assign(slots, nowhere);
  for (Place p = 0; p < size(); ++p) places_[members_[p].slot] = p;
}

void Roster::save(ByteWriter& w) const {
  w.put_all(members());
  w.put(static_cast<std::uint64_t>(slots()));
  w.put_all(std::span<const Slot>(free_));
}

void Roster::load(ByteReader& r) {
  std::vector<Member> members;
  r.get_all(members);
  const auto slots = r.get<std::uint64_t>();
  std::vector<Slot> free;
  r.get_all(free);
  restore(std::move(members), slots, std::move(free));
}

}  // namespace moraine::native
