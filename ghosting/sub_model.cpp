// SPDX-License-Identifier: Apache-2.0
#include "ghosting/sub_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace moraine {
namespace {

/// Worlds put their float32 origin in the middle of what they hold.
Vec3 middle(std::span<const ElementState> states) {
  Bounds box;
  for (const ElementState& s : states) box.add(s.pose.position);
  return states.empty() ? Vec3::Zero() : Vec3((box.min + box.max) / 2);
}

Body body(const ModelContext& context, std::uint32_t element, const ElementState& state) {
  const Element& e = context.scene->elements[element];
  return {e.id, e.shape, e.material, e.mass, Role::real, state};
}

}  // namespace

std::span<const runtime::Stage> SubModel::stages() {
  static constexpr std::array table{
      runtime::Stage{"ghost_build", bound_update_stage},
      runtime::Stage{"step", runtime::Stage::none},
      runtime::Stage{"force_mirror", step_stage},
      runtime::Stage{"bound_update", runtime::Stage::none},
  };
  return table;
}

SubModel::SubModel(const ModelContext& context, SubModelId id, std::vector<std::uint32_t> members,
                   std::span<const ElementState> states, std::span<const std::uint32_t> inner_bonds,
                   std::span<const ContactMemory> memory)
    : context_(context),
      id_(id),
      origin_(middle(states)),
      members_(std::move(members)),
      shared_index_(members_.size(), -1),
      world_(context.engine->make(context.world, origin_)) {
  for (auto* v : {&radius_, &mass_}) v->reserve(members_.size());
  for (auto* v : {&slots_, &shape_}) v->reserve(members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    slots_.push_back(world_->add(body(context_, members_[i], states[i])));
    radius_.push_back(context_.radius(members_[i]));
    mass_.push_back(context_.element_mass(members_[i]));
    shape_.push_back(context_.scene->elements[members_[i]].shape);
    largest_radius_ = std::max(largest_radius_, radius_[i]);
    total_mass_ += mass_[i];
  }
  inner_bonds_.assign(inner_bonds.begin(), inner_bonds.end());
  for (const std::uint32_t b : inner_bonds) {
    const auto [first, second] = context_.bond_ends[b];
    world_->add_bond(b, slots_[member_index(first)], slots_[member_index(second)]);
  }
  world_->remember(memory);
  read_motions();
  update_bounds();
}

std::span<const runtime::SubModelId> SubModel::sources(int stage) const {
  if (stage == ghost_build_stage) return owners_;
  if (stage == force_mirror_stage) return hosts_;
  return {};
}

std::span<const runtime::SubModelId> SubModel::targets(int stage) const {
  if (stage == step_stage) return owners_;
  if (stage == bound_update_stage) return hosts_;
  return {};
}

void SubModel::run(int stage, const runtime::Round& round, runtime::Port& port) {
  switch (stage) {
    case ghost_build_stage:
      return ghost_build(round, port);
    case step_stage:
      return step(round, port);
    case force_mirror_stage:
      return force_mirror(round, port);
    case bound_update_stage:
      return bound_update(round, port);
  }
}

/// In units of a body's or a contact's share of an engine step; the other stages are a few per cent of it.
double SubModel::counted_work(int stage) const {
  const auto members = static_cast<double>(members_.size());
  const auto ghosts = static_cast<double>(ghost_count());
  const StepWork work = world_->work();
  switch (stage) {
    case ghost_build_stage:
      return 0.1 * ghosts;
    case step_stage:
      if (resting_) return 0.01 * members;
      return static_cast<double>(work.bodies + work.contacts) + 0.2 * static_cast<double>(work.bonds);
    case force_mirror_stage:
      return 0.1 * static_cast<double>(shared_.size()) + 0.02 * members;
    default:
      return 0.1 * static_cast<double>(shared_.size()) + 0.02 * members;
  }
}

std::span<const std::string_view> SubModel::counters() {
  static constexpr std::array<std::string_view, 3> names{"elements", "contacts", "ghosts"};
  return names;
}

void SubModel::count(std::span<std::uint32_t> out) const {
  out[0] = static_cast<std::uint32_t>(members_.size());
  out[1] = resting_ ? 0 : static_cast<std::uint32_t>(world_->work().contacts);
  out[2] = static_cast<std::uint32_t>(ghost_count());
}

/// A body with its share of contacts and of the engine's bookkeeping, measured.
double SubModel::memory() const { return 4000.0 * static_cast<double>(members_.size() + ghost_count()); }

Report SubModel::report() const {
  return {bounds_,       max_speed_,    extremes(), ledger(), disagreement_, disagreements_,
          ghost_count(), ghost_rounds_, rounds_,    rested_,  broken_};
}

std::size_t SubModel::ghost_count() const {
  std::size_t n = 0;
  for (const HostLink& link : host_links_) n += link.ghosts.size();
  return n;
}

std::size_t SubModel::member_index(std::uint32_t element) const {
  return static_cast<std::size_t>(std::lower_bound(members_.begin(), members_.end(), element) - members_.begin());
}

ElementState SubModel::state(std::size_t member) const {
  const std::int32_t at = shared_index_[member];
  return at < 0 ? world_->state(slots_[member]) : shared_[static_cast<std::size_t>(at)].state;
}

void SubModel::set_neighbours(std::span<const Neighbour> neighbours) {
  interrupted_ = false;
  std::vector<HostLink> old_hosts = std::move(host_links_);
  std::vector<OwnerLink> old_owners = std::move(owner_links_);
  host_links_.clear();
  owner_links_.clear();
  for (const Neighbour& n : neighbours) {
    if (context_.coupling->hosts(id_, n.id)) {
      const auto same = std::find_if(old_hosts.begin(), old_hosts.end(), [&](auto& l) { return l.owner == n.id; });
      HostLink link = same == old_hosts.end() ? HostLink{n.id, {}, 0, false, {}, n.bonds, {}} : std::move(*same);
      link.bounds = n.bounds;
      link.max_speed = n.max_speed;
      host_links_.push_back(std::move(link));
    }
    if (context_.coupling->hosts(n.id, id_)) {
      const auto same = std::find_if(old_owners.begin(), old_owners.end(), [&](auto& l) { return l.host == n.id; });
      owner_links_.push_back(same == old_owners.end() ? OwnerLink{n.id, false, {}, {}, {}, n.bonds, {}, {}}
                                                      : std::move(*same));
    }
  }
  for (HostLink& gone : old_hosts)
    for (const Ghost& g : gone.ghosts) world_->remove(g.slot);
  const auto had_ghosts = [](const auto& links, auto ghosts) {
    return std::any_of(links.begin(), links.end(), [&](const auto& link) { return !(link.*ghosts).empty(); });
  };
  if (had_ghosts(old_hosts, &HostLink::ghosts) || had_ghosts(old_owners, &OwnerLink::hosted)) wake();
  list_partners();
  update_shared();
}

void SubModel::list_partners() {
  owners_.clear();
  hosts_.clear();
  for (const HostLink& l : host_links_) owners_.push_back(l.owner);
  for (const OwnerLink& l : owner_links_) hosts_.push_back(l.host);
}

}  // namespace moraine
