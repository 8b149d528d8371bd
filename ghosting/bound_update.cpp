// SPDX-License-Identifier: Apache-2.0
// Bound update: where this sub-model's elements are now, which of them need a ghost where, and with what they start.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ghosting/sub_model.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

constexpr double drop_factor =
    1.5;  // ghosts are made below the skin and dropped above 1.5 skins, so they do not flicker

}  // namespace

void SubModel::bound_update(const runtime::Round& round, runtime::Port& port) {
  if (!(round.opening() && interrupted_)) {
    if (!resting_) {
      update_bounds();
      check_motions(round);
    }
    if (choose_ghosts() && resting_) wake();
  }
  if (!resting_) start_all_shared();
  for (const OwnerLink& link : owner_links_) send_ghosts(link, port);
  if (!round.opening()) watch_rest(round);
}

void SubModel::start_all_shared() {
  note_meetings();
  for (SharedElement& shared : shared_) {
    context_.coupling->share_out(shared, id_);
    start_shared(shared);
  }
}

/// Of the members as they are now: all that the next substep asks of each of them, in one pass over them.
void SubModel::update_bounds() {
  const double ahead = context_.engine->force_time * context_.world.substep;
  bounds_ = {};
  mass_moment_.setZero();
  double speed2 = 0, turning = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const BodyMotion& m = motions_[i];
    bounds_.add(m.position, radius_[i]);
    speed2 = std::max(speed2, m.twist.linear.squaredNorm());
    mass_moment_ += mass_[i] * (m.position + ahead * m.twist.linear);
    turning += m.twist.angular.sum();
  }
  max_speed_ = std::sqrt(speed2);
  finite_ = std::isfinite(mass_moment_.sum() + turning);
}

/// Errors: InvalidStateError naming the element and the step when a number is not finite or a speed beyond the limit.
void SubModel::check_motions(const runtime::Round& round) const {
  const double limit = context_.speed_limit;
  if (finite_ && max_speed_ <= limit) return;
  const auto bad = std::find_if(motions_.begin(), motions_.end(), [&](const BodyMotion& m) {
    return !std::isfinite(m.position.sum() + m.twist.angular.sum()) || !(m.twist.linear.norm() <= limit);
  });
  if (bad == motions_.end()) throw std::logic_error("motions are unsound, and none of them is");
  const auto step = round.number / context_.scene->time.substeps;
  const ElementId id = context_.scene->elements[members_[static_cast<std::size_t>(bad - motions_.begin())]].id;
  if (const double speed = bad->twist.linear.norm(); std::isfinite(speed) && speed > limit)
    throw InvalidStateError(
        fmt::format("element {} runs away at step {}: speed {:.4g} m/s, the limit is {:.4g} m/s "
                    "(run.max_speed); try a smaller dt or more substeps",
                    id, step, speed, limit));
  throw InvalidStateError(fmt::format("element {} has a state that is not a number at step {}", id, step));
}

/// Where the host told its border; the others' ghosts stay. Returns whether any have changed.
bool SubModel::choose_ghosts() {
  bool changed = false;
  for (OwnerLink& link : owner_links_) {
    if (link.border_is_new && choose_hosted(link)) changed = true;
    link.border_is_new = false;
  }
  if (changed) update_shared();
  return changed;
}

/// By distance, with memory, and by bond. Returns whether the list has changed.
bool SubModel::choose_hosted(OwnerLink& link) {
  find_touching(link, found_);
  std::erase_if(link.bonds,
                [&](const CrossBond& b) { return std::binary_search(broken_.begin(), broken_.end(), b.bond); });
  for (const CrossBond& b : link.bonds) {
    found_.push_back(b.own);
    link.meeting.push_back(b.own);
  }
  std::sort(link.meeting.begin(), link.meeting.end());
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  if (found_ == link.hosted) return false;
  std::swap(found_, link.hosted);
  return true;
}

/// Members whose bounding sphere comes closer than the skin to that of an element of the host, ascending. Of these, the
/// link notes the ones that meet one.
void SubModel::find_touching(OwnerLink& link, std::vector<std::uint32_t>& out) {
  out.clear();
  link.meeting.clear();
  if (link.border.empty()) return;
  Bounds box;
  for (const BorderElement& b : link.border) box.add(b.position, b.radius);
  const double largest = list_points(link.border);
  grid_.build(points_, largest + largest_radius_ + drop_factor * context_.skin);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const BodyMotion& own = motions_[i];
    const double radius = radius_[i];
    if (!box.within(radius + drop_factor * context_.skin, own.position)) continue;
    const bool hosted = std::binary_search(link.hosted.begin(), link.hosted.end(), members_[i]);
    const double reach = radius + context_.skin * (hosted ? drop_factor : 1.0);
    bool touches = false, meets = false;
    grid_.around(point(own.position), [&](std::uint32_t k) {
      if (meets) return;
      const double limit = reach + link.border[k].radius;
      if ((link.border[k].position - own.position).squaredNorm() > limit * limit) return;
      touches = true;
      meets = about_to_meet(own, radius, link.border[k]);
    });
    if (touches) out.push_back(members_[i]);
    if (meets) link.meeting.push_back(members_[i]);
  }
}

/// Their places become points_. Returns the largest radius [m].
double SubModel::list_points(std::span<const BorderElement> bodies) {
  points_.clear();
  double largest = 0;
  for (const BorderElement& b : bodies) {
    points_.push_back(point(b.position));
    largest = std::max(largest, b.radius);
  }
  return largest;
}

/// Brings the list of shared elements in line with the hosted lists of all links.
void SubModel::update_shared() {
  wanted_.clear();
  for (const OwnerLink& link : owner_links_)
    for (const std::uint32_t e : link.hosted) wanted_.emplace_back(e, link.host);
  std::sort(wanted_.begin(), wanted_.end());

  std::swap(shared_, shared_before_);
  shared_.clear();
  std::fill(shared_index_.begin(), shared_index_.end(), -1);
  auto old = shared_before_.begin();
  for (auto at = wanted_.begin(); at != wanted_.end();) {
    const std::uint32_t element = at->first;
    for (; old != shared_before_.end() && old->element < element; ++old) unshare(*old);
    SharedElement shared;
    if (old != shared_before_.end() && old->element == element) {
      shared = std::move(*old++);
    } else {
      shared.element = element;
      shared.member = static_cast<std::uint32_t>(member_index(element));
      shared.state = world_->state(slots_[shared.member]);
      shared.copies = {Copy::in(id_)};
    }
    std::vector<SubModelId> worlds{id_};
    for (; at != wanted_.end() && at->first == element; ++at) worlds.push_back(at->second);
    std::sort(worlds.begin(), worlds.end());
    const bool same = std::equal(worlds.begin(), worlds.end(), shared.copies.begin(), shared.copies.end(),
                                 [](SubModelId w, const Copy& c) { return w == c.world; });
    if (!same) context_.coupling->change_copies(shared, worlds, id_);
    shared_index_[shared.member] = static_cast<std::int32_t>(shared_.size());
    shared_.push_back(std::move(shared));
  }
  for (; old != shared_before_.end(); ++old) unshare(*old);
  locate_hosted();
}

void SubModel::locate_hosted() {
  for (OwnerLink& link : owner_links_) {
    link.shared.clear();
    for (const std::uint32_t e : link.hosted)
      link.shared.push_back(static_cast<std::uint32_t>(shared_index_[member_index(e)]));
  }
}

ElementState SubModel::start_of(const SharedElement& shared, SubModelId world) const {
  if (context_.followers()) return shared.state;
  return {shared.state.pose, shared.state.twist + shared.copy_in(world).offset};
}

/// The real copy of an element with followers needs no telling.
void SubModel::start_shared(SharedElement& shared) {
  if (context_.followers()) return;
  const Slot slot = slots_[shared.member];
  const Copy& real = shared.copy_in(id_);
  world_->set_mass(slot, mass_[shared.member] * real.share, real.carries);
  world_->set_state(slot, start_of(shared, id_));
  shared.start = {{world_->position(slot), shared.state.pose.orientation}, shared.state.twist};
}

/// The last ghost is gone: what all copies carried sums to nothing, so the element just goes on.
void SubModel::unshare(const SharedElement& shared) {
  if (context_.followers()) return;
  const Slot slot = slots_[shared.member];
  world_->set_mass(slot, mass_[shared.member], false);
  world_->set_state(slot, shared.state);
}

void SubModel::send_ghosts(const OwnerLink& link, runtime::Port& port) {
  bound_message_.bounds = bounds_;
  bound_message_.max_speed = max_speed_;
  bound_message_.ghosts.clear();
  for (const std::uint32_t at : link.shared) {
    const SharedElement& shared = shared_[at];
    const Copy& copy = shared.copy_in(link.host);
    bound_message_.ghosts.push_back({shared.element, copy.carries, copy.share, start_of(shared, link.host)});
  }
  bound_message_.broken_bonds = newly_broken_;
  bound_message_.resting = resting_;
  bound_message_.write(bytes_);
  port.send(link.host, bytes_);
}

}  // namespace moraine
