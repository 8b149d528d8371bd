// SPDX-License-Identifier: Apache-2.0
// Force mirror: the owner turns what an element's copies did into the element's one state, and what they carry on.
#include <algorithm>
#include <stdexcept>

#include "ghosting/sub_model.hpp"

namespace moraine {

void SubModel::force_mirror(const runtime::Round& round, runtime::Port& port) {
  if (round.opening() && interrupted_) return;
  if (resting_) return mirror_at_rest(round, port);
  for (OwnerLink& link : owner_links_) receive_results(link, port.received(link.host));
  if (round.opening()) return;
  for (SharedElement& shared : shared_) combine(shared);
  close_account();
}

void SubModel::receive_results(OwnerLink& link, std::span<const std::byte> bytes) {
  step_message_.read(bytes);
  receive_border(link);
  std::swap(link.results, step_message_.results);
  note_broken(step_message_.broken_bonds);
  forget_bonds(step_message_.broken_bonds);
}

void SubModel::receive_border(OwnerLink& link) {
  link.border_is_new = step_message_.border_is_new;
  std::swap(link.border, step_message_.border);
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
  copy_motions_.clear();
  if (!context_.followers()) collect_motions(shared);
  const CouplingContext context{id_, context_.scene->gravity * context_.world.substep,
                                context_.scene->run.coupling_leak.value_or(context_.engine->coupling_leak)};
  disagreement_ += context_.coupling->combine(shared, copy_motions_, context);
  disagreements_ += shared.copies.size();
  motions_[shared.member] = {shared.state.pose.position, shared.state.twist};
}

}  // namespace moraine
