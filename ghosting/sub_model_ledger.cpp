// SPDX-License-Identifier: Apache-2.0
// What a sub-model's elements have of momentum and energy, what they were given, and which of them are at their limits.
#include <algorithm>

#include "ghosting/sub_model.hpp"

namespace moraine {

/// Angular momentum of spheres is I w; of other shapes the body-frame inertia is turned into the world frame.
Vec3 SubModel::spin(std::size_t member) const {
  const Shape& shape = context_.scene->shapes[shape_[member]];
  const Vec3& w = motions_[member].twist.angular;
  if (shape.sphere()) return mass_[member] * shape.inertia_per_mass.x() * w;
  const Quat q = state(member).pose.orientation;
  return q * Vec3(mass_[member] * shape.inertia_per_mass.cwiseProduct(q.conjugate() * w));
}

/// What gravity and boundaries gave in this substep.
void SubModel::close_account() {
  if (members_.empty()) return;
  const Vec3 step = context_.scene->gravity * context_.world.substep;
  const Impulse gravity{total_mass_ * step, mass_moment_.cross(step)};
  const Impulse walls = world_->boundary_impulse();
  ledger_.given += gravity;
  ledger_.given += walls;
  ledger_.from_boundaries += walls.linear;
  ledger_.work += world_->boundary_work();
  ledger_.exchanged += gravity.linear.norm() + walls.linear.norm();
  ledger_.exchanged_angular += gravity.angular.norm() + walls.angular.norm();
}

double SubModel::stretch_energy(std::uint32_t bond, const Vec3& between) const {
  const Bond& b = context_.scene->bonds[bond];
  const double stretch = between.norm() - b.rest_length;
  return 0.5 * b.stiffness * stretch * stretch;
}

/// Of bonds among members, and of those to ghosts; where both sides have ghosts, the lower sub-model counts them.
double SubModel::bond_energy() const {
  double sum = 0;
  for (const std::uint32_t b : inner_bonds_) {
    if (std::binary_search(broken_.begin(), broken_.end(), b)) continue;
    const auto [first, second] = context_.bond_ends[b];
    sum += stretch_energy(b, motions_[member_index(second)].position - motions_[member_index(first)].position);
  }
  for (const HostLink& link : host_links_) {
    if (id_ > link.owner && context_.coupling->hosts(link.owner, id_)) continue;
    for (const CrossBond& b : link.bonds) {
      const auto ghost = std::lower_bound(link.ghosts.begin(), link.ghosts.end(), b.other,
                                          [](const Ghost& g, std::uint32_t e) { return g.element < e; });
      if (!std::binary_search(link.held.begin(), link.held.end(), b.bond) || ghost == link.ghosts.end()) continue;
      sum += stretch_energy(b.bond, world_->position(ghost->slot) - motions_[member_index(b.own)].position);
    }
  }
  return sum;
}

Ledger SubModel::ledger() const {
  Ledger now = ledger_;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const BodyMotion& m = motions_[i];
    const Vec3 p = mass_[i] * m.twist.linear, orbit = m.position.cross(p), turn = spin(i);
    now.momentum += {p, orbit + turn};
    now.kinetic_energy += 0.5 * (p.dot(m.twist.linear) + turn.dot(m.twist.angular));
    now.speed_sum += p.norm();
    now.spin_scale += orbit.norm() + turn.norm();
    now.mass_moment += mass_[i] * m.position;
    now.mass += mass_[i];
  }
  now.potential_energy = -context_.scene->gravity.dot(now.mass_moment);
  now.bond_energy = bond_energy();
  now.contact_energy = world_->contact_energy();
  return now;
}

/// Boundaries are asked about single elements only if the box around all centres is not clear of them, and elements
/// themselves are looked up only where they may be the worst so far.
Extremes SubModel::extremes() const {
  Extremes out;
  const Enclosure& enclosure = context_.enclosure;
  const bool clear = !members_.empty() && enclosure.holds(bounds_.inflated(-std::ranges::min(radius_)));
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Element& e = context_.scene->elements[members_[i]];
    const BodyMotion& m = motions_[i];
    const double speed = m.twist.linear.norm();
    out.speed.note(speed, e.id);
    if (const double way = speed * context_.world.substep; way > out.stride.value * context_.least_inner_radius)
      out.stride.note(way / context_.inner_radius[shape_[i]], e.id);
    if (clear) continue;
    out.beyond.note(enclosure.beyond(m.position, e.state.pose.position) / radius_[i], e.id);
    out.below.note(enclosure.below(m.position) / radius_[i], e.id);
  }
  return out;
}

}  // namespace moraine
