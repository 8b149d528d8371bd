// SPDX-License-Identifier: Apache-2.0
// Ghost build: the host makes, moves and drops ghosts as their owners ordered.
#include <algorithm>

#include "ghosting/sub_model.hpp"

namespace moraine {

void SubModel::ghost_build(const runtime::Round& round, runtime::Port& port) {
  if (round.opening()) return;
  if (resting_ && disturbed(round, port)) wake();
  if (!resting_) build(port);
  ghost_rounds_ += ghost_count();
  ++rounds_;
}

void SubModel::build(const runtime::Port& port) {
  for (HostLink& link : host_links_) {
    bound_message_.read(port.received(link.owner));
    link.bounds = bound_message_.bounds;
    link.max_speed = bound_message_.max_speed;
    link.owner_rests = bound_message_.resting;
    note_broken(bound_message_.broken_bonds);
    update_ghosts(link, bound_message_);
    hold_bonds(link);
  }
}

/// Both lists ascend by element: one pass keeps, makes and drops.
void SubModel::update_ghosts(HostLink& link, const BoundMessage& message) {
  std::swap(link.ghosts, ghosts_before_);
  link.ghosts.clear();
  auto old = ghosts_before_.begin();
  for (const GhostOrder& order : message.ghosts) {
    for (; old != ghosts_before_.end() && old->element < order.element; ++old) drop_ghost(link, *old);
    const bool fresh = old == ghosts_before_.end() || old->element != order.element;
    link.ghosts.push_back(fresh ? Ghost{order.element, 0, {}} : *old++);
    place_ghost(link.ghosts.back(), order, fresh);
  }
  for (; old != ghosts_before_.end(); ++old) drop_ghost(link, *old);
}

void SubModel::place_ghost(Ghost& ghost, const GhostOrder& order, bool fresh) {
  if (!fresh && context_.followers()) {
    world_->set_state(ghost.slot, order.start);
    ghost.start = order.start;
    return;
  }
  const double mass = context_.element_mass(order.element) * order.share;
  if (fresh) {
    const Element& e = context_.scene->elements[order.element];
    ghost.slot = world_->add({e.id, e.shape, e.material, mass, Role::ghost, order.start, order.carries});
  } else {
    world_->set_mass(ghost.slot, mass, order.carries);
    world_->set_state(ghost.slot, order.start);
  }
  ghost.start = {{world_->position(ghost.slot), order.start.pose.orientation}, order.start.twist};
}

void SubModel::drop_ghost(HostLink& link, const Ghost& ghost) {
  std::erase_if(link.held, [&](std::uint32_t held) {
    const auto [first, second] = context_.bond_ends[held];
    const bool ends_here = first == ghost.element || second == ghost.element;
    if (ends_here) world_->remove_bond(held);
    return ends_here;
  });
  world_->remove(ghost.slot);
}

/// A bond across a cut lives where its ghost is.
void SubModel::hold_bonds(HostLink& link) {
  std::erase_if(link.bonds,
                [&](const CrossBond& b) { return std::binary_search(broken_.begin(), broken_.end(), b.bond); });
  for (const CrossBond& b : link.bonds) {
    if (std::binary_search(link.held.begin(), link.held.end(), b.bond)) continue;
    const auto ghost = std::lower_bound(link.ghosts.begin(), link.ghosts.end(), b.other,
                                        [](const Ghost& g, std::uint32_t e) { return g.element < e; });
    if (ghost == link.ghosts.end() || ghost->element != b.other) continue;
    world_->add_bond(b.bond, slots_[member_index(b.own)], ghost->slot);
    link.held.insert(std::upper_bound(link.held.begin(), link.held.end(), b.bond), b.bond);
  }
}

}  // namespace moraine
