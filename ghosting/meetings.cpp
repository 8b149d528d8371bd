// SPDX-License-Identifier: Apache-2.0
// Meetings: which copies of shared elements touch something in their worlds, or are about to. By bounding spheres, so
// rather too many than too few. Boundaries are not looked at: what meets nothing else than one is pushed by it.
#include <algorithm>
#include <cmath>

#include "ghosting/mass_split.hpp"
#include "ghosting/sub_model.hpp"

namespace moraine {
namespace {

constexpr double meeting_gap = 0.1;  // bodies touch below this share of the skin

}  // namespace

/// Within one and a half of the coming substeps, as speeds are known a substep late.
bool SubModel::about_to_meet(const BodyMotion& own, double radius, const BorderElement& other) const {
  const Vec3 between = other.position - own.position;
  const double contact = radius + other.radius + meeting_gap * context_.skin, distance2 = between.squaredNorm();
  if (distance2 <= contact * contact) return true;
  const double closing = between.dot(own.twist.linear - other.velocity);  // times the distance
  if (closing <= 0) return false;
  const double distance = std::sqrt(distance2);
  return distance - 1.5 * closing / distance * context_.world.substep <= contact;
}

void SubModel::note_meetings() {
  if (context_.followers()) return;
  for (const OwnerLink& link : owner_links_) note_meetings_at(link);
  note_meetings_here();
}

/// Which of the link's ghosts meet something there. Both lists ascend.
void SubModel::note_meetings_at(const OwnerLink& link) {
  auto meeting = link.meeting.begin();
  for (std::size_t k = 0; k < link.hosted.size(); ++k) {
    while (meeting != link.meeting.end() && *meeting < link.hosted[k]) ++meeting;
    shared_[link.shared[k]].copy_in(link.host).meets = meeting != link.meeting.end() && *meeting == link.hosted[k];
  }
}

/// Which real copies meet something here: only those are looked at that would be without mass for a ghost's sake. To be
/// about to meet something counts as a push, so that they are not looked at again before that is forgotten.
void SubModel::note_meetings_here() {
  found_.clear();
  for (std::uint32_t at = 0; at < shared_.size(); ++at) {
    const std::vector<Copy>& copies = shared_[at].copies;
    if (!busy(shared_[at].copy_in(id_)) && std::any_of(copies.begin(), copies.end(), busy)) found_.push_back(at);
  }
  if (found_.empty()) return;
  list_bodies_here();
  for (const std::uint32_t at : found_)
    if (meets_here(shared_[at].member)) shared_[at].copy_in(id_).unpushed = 0;
}

bool SubModel::meets_here(std::uint32_t member) const {
  bool meets = false;
  grid_.around(point(motions_[member].position), [&](std::uint32_t k) {
    meets = meets || (k != member && about_to_meet(motions_[member], radius_[member], here_[k]));
  });
  return meets;
}

/// The members, then the ghosts, where they are if nothing has pushed them: to ask the engine would cost more.
void SubModel::list_bodies_here() {
  here_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i)
    here_.push_back({motions_[i].position, motions_[i].twist.linear, radius_[i]});
  for (const HostLink& link : host_links_)
    for (const Ghost& g : link.ghosts)
      here_.push_back({g.start.pose.position + context_.world.substep * g.start.twist.linear, g.start.twist.linear,
                       context_.radius(g.element)});
  const double largest = list_points(here_);
  grid_.build(points_, 2 * largest + context_.skin);
}

}  // namespace moraine
