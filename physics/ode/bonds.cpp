// SPDX-License-Identifier: Apache-2.0
#include "physics/ode/bonds.hpp"

#include <algorithm>

namespace moraine::ode {

void Bonds::add(const Entry& entry) {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), entry.bond,
                                   [](const Entry& e, std::uint32_t wanted) { return e.bond < wanted; });
  entries_.insert(at, entry);
}

void Bonds::remove(std::uint32_t bond) {
  std::erase_if(entries_, [&](const Entry& e) { return e.bond == bond; });
}

void Bonds::break_long(const Bodies& bodies) {
  broken_.clear();
  for (const Entry& e : entries_) {
    const double limit = scene_.bonds[e.bond].break_length;
    const Vec3 between = bodies.position(bodies.place(e.b)) - bodies.position(bodies.place(e.a));
    if (!(between.squaredNorm() <= limit * limit)) broken_.push_back(e.bond);
  }
  std::erase_if(entries_, [&](const Entry& e) { return std::binary_search(broken_.begin(), broken_.end(), e.bond); });
}

void Bonds::make_joints(const Bodies& bodies, const Units& units, double h, dWorldID world, dJointGroupID group) const {
  for (const Entry& e : entries_) {
    const Bond& bond = scene_.bonds[e.bond];
    const double stiffness = bond.stiffness * units.time * units.time / units.mass;
    const double damping = bond.damping * units.time / units.mass;
    if (stiffness == 0 && damping == 0) continue;
    const Place p = bodies.place(e.a), q = bodies.place(e.b);
    if (!bodies.sound(p) || !bodies.sound(q)) continue;
    const dBodyID a = bodies.body(p), b = bodies.body(q);
    const dJointID joint = dJointCreateDBall(world, group);
    dJointAttach(joint, a, b);
    const dReal *at_a = dBodyGetPosition(a), *at_b = dBodyGetPosition(b);
    dJointSetDBallAnchor1(joint, at_a[0], at_a[1], at_a[2]);
    dJointSetDBallAnchor2(joint, at_b[0], at_b[1], at_b[2]);
    dJointSetDBallDistance(joint, bond.rest_length / units.length);
    dJointSetDBallParam(joint, dParamERP, h * stiffness / (h * stiffness + damping));
    dJointSetDBallParam(joint, dParamCFM, 1 / (h * stiffness + damping));
  }
}

}  // namespace moraine::ode
