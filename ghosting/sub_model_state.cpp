// SPDX-License-Identifier: Apache-2.0
// A sub-model to bytes and back: its world, and all that it knows of its neighbours and of what copies carry.
#include "ghosting/fields.hpp"

namespace moraine {

/// Border elements and results are of one round only and are exchanged anew in the opening round of an epoch.
template <class Io, class Self>
void SubModel::fields(Io& s, Self& self) {
  moraine::fields::all(s, self.members_, self.slots_, self.shared_index_, self.host_links_, self.owner_links_,
                       self.shared_, self.inner_bonds_, self.broken_, self.largest_radius_, self.total_mass_,
                       self.approached_, self.ledger_, self.disagreement_, self.disagreements_, self.ghost_rounds_,
                       self.rounds_, self.radius_, self.mass_, self.shape_, self.resting_, self.still_rounds_,
                       self.still_since_, self.at_rest_, self.rested_);
}

void SubModel::save(std::vector<std::byte>& out) const {
  std::vector<std::byte> world;
  world_->save(world);
  ByteWriter w(out);
  moraine::fields::all(w, origin_);
  w.put_all(std::span<const std::byte>(world));
  fields(w, *this);
}

void SubModel::load(std::span<const std::byte> in) {
  ByteReader r(in);
  moraine::fields::all(r, origin_);
  world_ = context_.engine->make(context_.world, origin_);
  std::vector<std::byte> world;
  r.get_all(world);
  world_->load(world);
  fields(r, *this);
  list_partners();
  locate_hosted();
  read_motions();
  for (const SharedElement& s : shared_) motions_[s.member] = {s.state.pose.position, s.state.twist};
  update_bounds();
}

}  // namespace moraine
