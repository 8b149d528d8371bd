// SPDX-License-Identifier: Apache-2.0
// Force mirror: the owner turns what an element's copies did into the element's one state, and what they carry on.
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "ghosting/sub_model.hpp"

namespace moraine {

void SubModel::force_mirror(const runtime::Round& round, runtime::Port& port) {
  if (round.opening() && interrupted_) return;
  for (OwnerLink& link : owner_links_) receive_results(link, port.received(link.host));
  if (round.opening()) return;
  for (SharedElement& shared : shared_) combine(shared);
  close_account();
}

void SubModel::receive_results(OwnerLink& link, std::span<const std::byte> bytes) {
  step_message_.read(bytes);
  link.border_is_new = step_message_.border_is_new;
  std::swap(link.border, step_message_.border);
  std::swap(link.results, step_message_.results);
  note_broken(step_message_.broken_bonds);
  forget_bonds(step_message_.broken_bonds);
}

/// The other side broke them: both sides see it in the same substep.
void SubModel::forget_bonds(std::span<const std::uint32_t> broken) {
  for (const std::uint32_t b : broken)
    for (HostLink& link : host_links_)
      if (std::erase(link.held, b) > 0) world_->remove_bond(b);
}

CopyMotion SubModel::own_motion(const SharedElement& shared) const {
  return {shared.end.pose.position - shared.start.pose.position,
          rotation_between(shared.start.pose.orientation, shared.end.pose.orientation), shared.end.twist};
}

void SubModel::collect_motions(const SharedElement& shared) {
  for (const Copy& copy : shared.copies) {
    if (copy.world == id_) {
      copy_motions_.push_back(own_motion(shared));
      continue;
    }
    const auto link = std::lower_bound(owner_links_.begin(), owner_links_.end(), copy.world,
                                       [](const OwnerLink& l, SubModelId w) { return l.host < w; });
    const auto at = std::lower_bound(link->results.begin(), link->results.end(), shared.element,
                                     [](const GhostResult& r, std::uint32_t e) { return r.element < e; });
    if (at == link->results.end() || at->element != shared.element)
      throw std::logic_error("a ghost did not report to its owner");
    copy_motions_.push_back(at->motion);
  }
}

void SubModel::combine(SharedElement& shared) {
  shared.end = world_->state(slots_[shared.member]);
  copy_motions_.clear();
  if (!context_.followers()) collect_motions(shared);
  const CouplingContext context{id_, context_.scene->gravity * context_.world.substep,
                                context_.scene->run.coupling_leak};
  disagreement_ += context_.coupling->combine(shared, copy_motions_, context);
  disagreements_ += shared.copies.size();
  motions_[shared.member] = {shared.state.pose.position, shared.state.twist};
}

/// Angular momentum of spheres is I w; of other shapes the body-frame inertia is turned into the world frame.
Vec3 SubModel::spin(std::size_t member) const {
  const Shape& shape = context_.scene->shape_of(context_.scene->elements[members_[member]]);
  const Vec3& w = motions_[member].twist.angular;
  if (shape.sphere()) return mass_[member] * shape.inertia_per_mass.x() * w;
  const Quat q = state(member).pose.orientation;
  return q * Vec3(mass_[member] * shape.inertia_per_mass.cwiseProduct(q.conjugate() * w));
}

/// Where the members' masses are when forces act.
void SubModel::open_account() {
  const double ahead = context_.engine->force_time * context_.world.substep;
  mass_moment_before_.setZero();
  for (std::size_t i = 0; i < members_.size(); ++i)
    mass_moment_before_ += mass_[i] * (motions_[i].position + ahead * motions_[i].twist.linear);
}

/// What gravity and boundaries gave in this substep.
void SubModel::close_account() {
  if (members_.empty()) return;
  const Vec3 step = context_.scene->gravity * context_.world.substep;
  const Impulse gravity{std::accumulate(mass_.begin(), mass_.end(), 0.0) * step, mass_moment_before_.cross(step)};
  const Impulse walls = world_->boundary_impulse();
  ledger_.given += gravity;
  ledger_.given += walls;
  ledger_.exchanged += gravity.linear.norm() + walls.linear.norm();
  ledger_.exchanged_angular += gravity.angular.norm() + walls.angular.norm();
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
  return now;
}

}  // namespace moraine
