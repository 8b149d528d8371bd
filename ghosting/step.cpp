// SPDX-License-Identifier: Apache-2.0
// Step: the engine advances this world alone; what its ghosts did is reported to their owners.
#include <algorithm>

#include "ghosting/sub_model.hpp"

namespace moraine {

void SubModel::step(const runtime::Round& round, runtime::Port& port) {
  if (resting_) newly_broken_.clear();
  if (!round.opening() && !resting_) advance(round);
  const bool borders = borders_due(round);
  step_message_.resting = resting_;
  for (HostLink& link : host_links_) {
    step_message_.border_is_new = borders && !(resting_ && link.owner_rests && !round.opening());
    report(link, round.opening(), step_message_);
    step_message_.write(bytes_);
    port.send(link.owner, bytes_);
  }
}

void SubModel::advance(const runtime::Round& round) {
  world_->step(static_cast<double>(round.number) * context_.world.substep);
  newly_broken_.assign(world_->broken_bonds().begin(), world_->broken_bonds().end());
  note_broken(newly_broken_);
  read_motions();
  for (SharedElement& shared : shared_) shared.end = world_->state(slots_[shared.member]);  // while it is in the cache
}

void SubModel::read_motions() { world_->motions(slots_, motions_); }

void SubModel::note_broken(std::span<const std::uint32_t> bonds) {
  for (const std::uint32_t b : bonds) {
    const auto at = std::lower_bound(broken_.begin(), broken_.end(), b);
    if (at == broken_.end() || *at != b) broken_.insert(at, b);
  }
}

void SubModel::report(const HostLink& link, bool opening, StepMessage& message) const {
  message.results.clear();
  message.border.clear();
  message.broken_bonds.clear();
  if (!opening) {
    if (!context_.followers())
      for (const Ghost& ghost : link.ghosts) message.results.push_back(result(ghost));
    for (const CrossBond& b : link.bonds)
      if (std::binary_search(newly_broken_.begin(), newly_broken_.end(), b.bond))
        message.broken_bonds.push_back(b.bond);
    std::sort(message.broken_bonds.begin(), message.broken_bonds.end());
  }
  if (message.border_is_new) report_border(link, message.border);
}

/// Partners change places as soon as they meet. Followers are made in advance: until two elements may have come closer
/// by the skin, less four substeps for what is known a substep late.
bool SubModel::borders_due(const runtime::Round& round) {
  if (!context_.followers()) return true;
  if (round.opening()) {
    if (!interrupted_) approached_ = 0;
    return !interrupted_;
  }
  double speed = 0;
  for (const HostLink& link : host_links_) speed = std::max(speed, link.max_speed);
  const double step = (speed + max_speed_) * context_.world.substep;
  approached_ += step;
  if (approached_ + 4 * step < context_.skin) return false;
  approached_ = 0;
  return true;
}

void SubModel::report_border(const HostLink& link, std::vector<BorderElement>& border) const {
  // The owner's bounds are a substep old: its elements have moved at most this far since.
  const double reach = 1.5 * context_.skin + 2 * link.max_speed * context_.world.substep;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (link.bounds.within(radius_[i] + reach, motions_[i].position))
      border.push_back({motions_[i].position, motions_[i].twist.linear, radius_[i]});
  }
}

GhostResult SubModel::result(const Ghost& ghost) const {
  const ElementState end = world_->state(ghost.slot);
  return {ghost.element,
          0,
          {end.pose.position - ghost.start.pose.position,
           rotation_between(ghost.start.pose.orientation, end.pose.orientation), end.twist}};
}

}  // namespace moraine
