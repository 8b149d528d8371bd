// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/bodies.hpp"

#include <algorithm>

namespace moraine::soft_sphere {
namespace {

template <class T>
void reorder(std::vector<T>& values, std::span<const Place> order) {
  std::vector<T> sorted;
  sorted.reserve(order.size());
  for (const Place p : order) sorted.push_back(values[p]);
  values = std::move(sorted);
}

}  // namespace

Place Bodies::find(ElementId id) const {
  const auto at = std::lower_bound(entries.begin(), entries.end(), id,
                                   [](const Entry& e, ElementId wanted) { return e.id < wanted; });
  return at != entries.end() && at->id == id ? static_cast<Place>(at - entries.begin()) : nowhere;
}

Slot Bodies::add(const Body& body, const Shape& shape) {
  if (free_.empty()) {
    free_.push_back(static_cast<Slot>(places_.size()));
    places_.push_back(nowhere);
  }
  const Slot slot = free_.back();
  free_.pop_back();
  const auto at = static_cast<Place>(size());
  places_[slot] = at;
  resize(size() + 1);
  entries[at] = {body.id, slot, body.shape, 0};
  ghost[at] = body.role == Role::ghost;
  moving[at].material = body.material;
  ball[at].radius = shape.sphere()->radius;
  set_mass(at, body.mass);
  set_state(at, body.state);
  unsettled_ = true;
  return slot;
}

void Bodies::resize(std::size_t size) {
  entries.resize(size);
  ghost.resize(size);
  position.resize(size);
  orientation.resize(size);
  moving.resize(size);
  ball.resize(size);
  load.resize(size);
  removed_.resize(size);
}

void Bodies::remove(Slot slot) {
  removed_[places_[slot]] = true;
  places_[slot] = nowhere;
  free_.push_back(slot);
  ++gone_;
  unsettled_ = true;
}

void Bodies::set_mass(Place place, double mass) {
  if (entries[place].mass == mass) return;
  entries[place].mass = mass;
  unsettled_ = true;
  moving[place].inverse_mass = 1 / mass;
}

void Bodies::set_state(Place place, const ElementState& state) {
  position[place] = state.pose.position;
  orientation[place] = state.pose.orientation;
  moving[place].velocity = state.twist.linear;
  moving[place].spin = state.twist.angular;
}

ElementState Bodies::state(Place place) const {
  return {{position[place], orientation[place]}, {moving[place].velocity, moving[place].spin}};
}

const std::vector<Place>& Bodies::settle() {
  order_.clear();
  for (Place p = 0; p < size(); ++p)
    if (!removed_[p]) order_.push_back(p);
  std::sort(order_.begin(), order_.end(), [&](Place a, Place b) { return entries[a].id < entries[b].id; });
  moved_.assign(size(), nowhere);
  for (Place p = 0; p < order_.size(); ++p) moved_[order_[p]] = p;
  reorder(entries, order_);
  reorder(ghost, order_);
  reorder(position, order_);
  reorder(orientation, order_);
  reorder(moving, order_);
  reorder(ball, order_);
  resize(order_.size());
  std::fill(removed_.begin(), removed_.end(), std::uint8_t{0});
  for (Place p = 0; p < size(); ++p) places_[entries[p].slot] = p;
  gone_ = 0;
  unsettled_ = false;
  return moved_;
}

void Bodies::clear() {
  resize(0);
  places_.clear();
  free_.clear();
  gone_ = 0;
  unsettled_ = false;
}

void Bodies::restore_slots(std::size_t slots, std::vector<Slot> free) {
  places_.assign(slots, nowhere);
  for (Place p = 0; p < size(); ++p) places_[entries[p].slot] = p;
  free_ = std::move(free);
  unsettled_ = false;
}

}  // namespace moraine::soft_sphere
