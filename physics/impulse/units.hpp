// SPDX-License-Identifier: Apache-2.0
// Between SI in the world frame and this engine's scaled, local float32 numbers.
#pragma once

#include "physics/types.hpp"
#include "physics/world.hpp"

namespace moraine::impulse {

/// Three numbers and a lane of zero (or of something else where stated), for the processor's four lanes.
using Vec = Eigen::Vector4f;

inline Vec narrow(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}
inline Vec3 wide(const Vec& v) { return {v.x(), v.y(), v.z()}; }
/// The same with a zero in the last lane.
inline Vec three(const Vec& v) { return v.cwiseProduct(Vec(1, 1, 1, 0)); }
// Without branches, where the outcome cannot be guessed.
inline float larger(float x, float y) { return Vec::Constant(x).cwiseMax(Vec::Constant(y))[0]; }
inline float positive(float x) { return larger(x, 0); }

/// A typical element has diameter 1 and mass 1, and falls its own diameter in about one unit of time. Positions are
/// relative to the world's origin: float32 keeps 1e-6 diameters wherever the world lies.
class Units {
 public:
  Units(const WorldSettings& s, const Vec3& origin)
      : length(s.length_unit), time(s.time_unit), mass(s.mass_unit), origin_(origin) {}

  const double length, time, mass;
  double velocity() const { return length / time; }
  double momentum() const { return mass * length / time; }
  double stiffness() const { return mass / (time * time); }

  Vec position(const Vec3& p) const { return narrow((p - origin_) / length); }
  Vec3 position(const Vec& p) const { return origin_ + length * wide(p); }

 private:
  Vec3 origin_;
};

}  // namespace moraine::impulse
