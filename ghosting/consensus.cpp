// SPDX-License-Identifier: Apache-2.0
// Consensus: an element's copies share its mass; after a substep their mean, weighted with the shares s_c, is the
// element.
//
// With v the mean of the copies' velocities v_c, the offsets d_c, by which the copies start apart, follow
//   d_c <- f d_c + (1 - f) g D_c + (v - v_c),   D_c <- D_c + a (d_c - D_c)
// so that a copy which was held back or pushed starts the next substep with the opposite. In the steady state s_c m d_c
// is the load that copy carries for the others. The mean is exact for momentum (every contact exists in one world only)
// and what the copies carry sums to zero. It is the scaled dual update of consensus ADMM (Boyd et al. 2011,
// eq. 7.3-7.5) interleaved with the time steps, with a leak f < 1 that keeps it from gaining energy. The less a
// world's contacts gain of themselves, the less has to leak, and the less cuts yield.
//
// A leak alone leaves v - v_c = (1 - f) d_c in the steady state: contacts and bonds at a cut are then loaded by copies
// that drift, and overlap or stretch more than others. So what leaks is the part that has not lasted: D_c is a slow
// mean of d_c. g < 1 and a much smaller than 1 - f keep the slow modes of a stack from gaining energy (integral
// action).
//
// Who has which share: see mass_split.hpp. A copy that alone meets something has all but all of the mass, so an impact
// at a cut is the impact that it would be without the cut.
#include "ghosting/mass_split.hpp"

namespace moraine {
namespace {

constexpr double lasting_rate = 0.002;  // a: share per substep; 0.01 lets a column of 50 in 5 sub-models hop
constexpr double lasting_share = 0.9;   // g: the drift that is left is a tenth; 1 lets the same column hop

/// d <- f d + (1 - f) g D + disagreement; D follows d slowly.
void carry(Vec3& offset, Vec3& lasting, const Vec3& disagreement, double leak) {
  offset = leak * offset + (1 - leak) * lasting_share * lasting + disagreement;
  lasting += lasting_rate * (offset - lasting);
}

/// What an old copy carries goes to its heir.
void inherit(Copy& heir, const Copy& old) {
  heir.offset += old.share / heir.share * old.offset;
  heir.lasting += old.share / heir.share * old.lasting;
}

Copy* find(std::vector<Copy>& copies, SubModelId world) {
  const auto at = std::find_if(copies.begin(), copies.end(), [&](const Copy& c) { return c.world == world; });
  return at == copies.end() ? nullptr : &*at;
}

CopyMotion mean_of(std::span<const Copy> copies, std::span<const CopyMotion> motions) {
  CopyMotion sum;
  double shares = 0;
  for (std::size_t c = 0; c < motions.size(); ++c) {
    const double share = copies[c].share;
    shares += share;
    sum.displacement += share * motions[c].displacement;
    sum.rotation += share * motions[c].rotation;
    sum.twist += share * motions[c].twist;
  }
  return {sum.displacement / shares, sum.rotation / shares, 1 / shares * sum.twist};
}

class Consensus final : public Coupling {
 public:
  /// One ghost per touching pair is enough; it lives in the sub-model with the lower number.
  bool hosts(SubModelId host, SubModelId owner) const override { return host < owner; }
  void share_out(SharedElement& shared, SubModelId owner) const override { split_mass(shared.copies, owner); }

  double combine(SharedElement& shared, std::span<const CopyMotion> motions,
                 const CouplingContext& context) const override {
    const CopyMotion mean = mean_of(shared.copies, motions);
    double disagreement = 0;
    for (std::size_t c = 0; c < motions.size(); ++c) {
      const Twist& end = motions[c].twist;
      Copy& copy = shared.copies[c];
      const Vec3 unpushed = shared.state.twist.linear + copy.offset.linear + context.gravity_step;
      note_push(copy, (end.linear - unpushed).norm(), end.linear.norm(), context.gravity_step.norm());
      const Vec3 linear = mean.twist.linear - end.linear;
      carry(copy.offset.linear, copy.lasting.linear, linear, context.leak);
      carry(copy.offset.angular, copy.lasting.angular, mean.twist.angular - end.angular, context.leak);
      disagreement += linear.squaredNorm();
    }
    shared.state.pose.position = shared.start.pose.position + mean.displacement;
    shared.state.pose.orientation = rotated(shared.state.pose.orientation, mean.rotation);
    shared.state.twist = mean.twist;
    return disagreement;
  }

  /// What dropped copies carry goes to the real one; new copies start with nothing.
  void change_copies(SharedElement& shared, std::span<const SubModelId> worlds, SubModelId owner) const override {
    std::vector<Copy> before = std::move(shared.copies);
    shared.copies.clear();
    for (const SubModelId w : worlds) {
      const Copy* same = find(before, w);
      shared.copies.push_back(same != nullptr ? *same : Copy::in(w));
    }
    Copy& real = *find(shared.copies, owner);
    if (real.share == 0) real.share = 1;
    for (const Copy& old : before)
      if (find(shared.copies, old.world) == nullptr) inherit(real, old);
  }
};

}  // namespace

std::unique_ptr<Coupling> make_consensus() { return std::make_unique<Consensus>(); }

}  // namespace moraine
