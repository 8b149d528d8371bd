// SPDX-License-Identifier: Apache-2.0
// Consensus: an element's k copies have mass m/k each; after a substep their mean is the element.
//
// With v the mean of the copies' velocities v_c, the offsets d_c, by which the copies start apart, follow
//   d_c <- f d_c + (1 - f) g D_c + (v - v_c),   D_c <- D_c + a (d_c - D_c)
// so that a copy which was held back or pushed starts the next substep with the opposite. In the steady state m/k d_c
// is the load that copy carries for the others. The mean is exact for momentum (every contact exists in one world only)
// and the offsets sum to zero. It is the scaled dual update of consensus ADMM (Boyd et al. 2011, eq. 7.3-7.5)
// interleaved with the time steps, with a leak f < 1 that keeps it from gaining energy.
//
// A leak alone leaves v - v_c = (1 - f) d_c in the steady state: contacts and bonds at a cut are then loaded by copies
// that drift, and overlap or stretch more than others. So what leaks is the part that has not lasted: D_c is a slow
// mean of d_c. g < 1 and a much smaller than 1 - f keep the slow modes of a stack from gaining energy (integral
// action).
#include "ghosting/coupling.hpp"

namespace moraine {
namespace {

constexpr double lasting_rate = 0.002;  // a: share per substep; 0.01 lets a column of 50 in 5 sub-models hop
constexpr double lasting_share = 0.9;   // g: the drift that is left is a tenth; 1 lets the same column hop

/// d <- f d + (1 - f) g D + disagreement; D follows d slowly.
void carry(Vec3& offset, Vec3& lasting, const Vec3& disagreement, double leak) {
  offset = leak * offset + (1 - leak) * lasting_share * lasting + disagreement;
  lasting += lasting_rate * (offset - lasting);
}

void inherit(Copy& heir, const Copy& old, double rescale) {
  heir.offset += rescale * old.offset;
  heir.lasting += rescale * old.lasting;
}

class Consensus final : public Coupling {
 public:
  /// One ghost per touching pair is enough; it lives in the sub-model with the lower number.
  bool hosts(SubModelId host, SubModelId owner) const override { return host < owner; }
  double mass_share(std::size_t copies) const override { return 1.0 / static_cast<double>(copies); }

  double combine(SharedElement& shared, std::span<const CopyMotion> motions,
                 const CouplingContext& context) const override {
    const CopyMotion mean = mean_of(motions);
    shared.state.pose.position = shared.start.pose.position + mean.displacement;
    shared.state.pose.orientation = rotated(shared.state.pose.orientation, mean.rotation);
    shared.state.twist = mean.twist;
    double disagreement = 0;
    for (std::size_t c = 0; c < motions.size(); ++c) {
      const Vec3 linear = mean.twist.linear - motions[c].twist.linear;
      const Vec3 angular = mean.twist.angular - motions[c].twist.angular;
      Copy& copy = shared.copies[c];
      carry(copy.offset.linear, copy.lasting.linear, linear, context.leak);
      carry(copy.offset.angular, copy.lasting.angular, angular, context.leak);
      disagreement += linear.squaredNorm();
    }
    return disagreement;
  }

  /// Offsets times mass share are what the copies carry. That is kept: shares of dropped copies go to the real one, new
  /// copies start with none.
  void change_copies(SharedElement& shared, std::span<const SubModelId> worlds, SubModelId owner) const override {
    const std::vector<Copy> before = std::move(shared.copies);
    shared.copies.clear();
    for (const SubModelId w : worlds) shared.copies.push_back(Copy::in(w));
    const double rescale =
        static_cast<double>(worlds.size()) / std::max<double>(1.0, static_cast<double>(before.size()));
    for (const Copy& old : before) {
      Copy* heir = find(shared.copies, old.world);
      if (!heir) heir = find(shared.copies, owner);
      inherit(*heir, old, rescale);
    }
  }

 private:
  static CopyMotion mean_of(std::span<const CopyMotion> motions) {
    CopyMotion sum;
    for (const CopyMotion& m : motions) {
      sum.displacement += m.displacement;
      sum.rotation += m.rotation;
      sum.twist.linear += m.twist.linear;
      sum.twist.angular += m.twist.angular;
    }
    const double n = static_cast<double>(motions.size());
    return {sum.displacement / n, sum.rotation / n, {sum.twist.linear / n, sum.twist.angular / n}};
  }

  static Copy* find(std::vector<Copy>& copies, SubModelId world) {
    for (Copy& c : copies)
      if (c.world == world) return &c;
    return nullptr;
  }
};

}  // namespace

std::unique_ptr<Coupling> make_consensus() { return std::make_unique<Consensus>(); }

}  // namespace moraine
