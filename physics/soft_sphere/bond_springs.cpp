// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/bond_springs.hpp"

#include <algorithm>

namespace moraine::soft_sphere {

void BondSprings::add(std::uint32_t bond, Slot a, Slot b) {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), bond,
                                   [](const Entry& e, std::uint32_t wanted) { return e.bond < wanted; });
  entries_.insert(at, {bond, a, b});
}

void BondSprings::remove(std::uint32_t bond) {
  std::erase_if(entries_, [&](const Entry& e) { return e.bond == bond; });
}

void BondSprings::break_long(const Bodies& bodies) {
  broken_.clear();
  for (const Entry& e : entries_) {
    const double limit = scene_->bonds[e.bond].break_length;
    const Vec3 between = bodies.position[bodies.place(e.b)] - bodies.position[bodies.place(e.a)];
    if (!(between.squaredNorm() <= limit * limit)) broken_.push_back(e.bond);
  }
  if (broken_.empty()) return;
  std::erase_if(entries_, [&](const Entry& e) { return std::binary_search(broken_.begin(), broken_.end(), e.bond); });
}

void BondSprings::act(Bodies& bodies) const {
  for (const Entry& e : entries_) {
    const Bond& bond = scene_->bonds[e.bond];
    const Place a = bodies.place(e.a), b = bodies.place(e.b);
    const Vec3 between = bodies.ball[b].centre - bodies.ball[a].centre;
    const double length = between.norm();
    if (length == 0) continue;
    const Vec3 axis = between / length;
    const double parting = (bodies.moving[b].velocity - bodies.moving[a].velocity).dot(axis);
    const Vec3 pull = (bond.stiffness * (length - bond.rest_length) + bond.damping * parting) * axis;
    bodies.load[a].force += pull;
    bodies.load[b].force -= pull;
  }
}

}  // namespace moraine::soft_sphere
