// SPDX-License-Identifier: Apache-2.0
// Mirror: the scheme of Longshaw et al. (2009) read literally, kept for comparison. Ghosts have the full mass and live
// on both sides of a cut; each starts a substep with its parent's state and is given the forces that acted on its
// parent in the last one. Each side keeps its own contact impulse, so momentum is not conserved and tall stacks are not
// stable.
#include "ghosting/coupling.hpp"

namespace moraine {
namespace {

class Mirror final : public Coupling {
 public:
  bool hosts(SubModelId, SubModelId) const override { return true; }
  void share_out(SharedElement& shared, SubModelId owner) const override {
    for (Copy& c : shared.copies) {
      c.share = 1;
      c.carries = c.world != owner;
    }
  }

  double combine(SharedElement& shared, std::span<const CopyMotion> motions,
                 const CouplingContext& context) const override {
    std::size_t real = 0;
    while (shared.copies[real].world != context.owner) ++real;
    const CopyMotion& own = motions[real];
    const Twist received{own.twist.linear - shared.state.twist.linear - context.gravity_step,
                         own.twist.angular - shared.state.twist.angular};
    shared.state.pose.position = shared.start.pose.position + own.displacement;
    shared.state.pose.orientation = rotated(shared.state.pose.orientation, own.rotation);
    shared.state.twist = own.twist;
    double disagreement = 0;
    for (std::size_t c = 0; c < motions.size(); ++c) {
      shared.copies[c].offset = c == real ? Twist{} : received;
      disagreement += (own.twist.linear - motions[c].twist.linear).squaredNorm();
    }
    return disagreement;
  }

  void change_copies(SharedElement& shared, std::span<const SubModelId> worlds, SubModelId) const override {
    shared.copies.clear();
    for (const SubModelId w : worlds) shared.copies.push_back(Copy::in(w));
  }
};

}  // namespace

std::unique_ptr<Coupling> make_mirror() { return std::make_unique<Mirror>(); }

}  // namespace moraine
