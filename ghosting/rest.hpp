// SPDX-License-Identifier: Apache-2.0
// Which sub-models are at rest and may be skipped.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/world.hpp"

namespace moraine {

struct RestLimits {
  double speed = 0;         ///< of members' surfaces, up to which they are still [m/s]; 0: nothing is skipped
  double shift = 0;         ///< by which a neighbour's ghost may be elsewhere than it was [m]
  std::int64_t rounds = 0;  ///< that a sub-model must have been still
  bool on() const { return speed > 0; }
};

/// `threshold` in units of sqrt(g d), RunSettings::skip_threshold. What turns round in a throw is slower than this for
/// 2 threshold sqrt(d/g), so sub-models must have been still for longer.
RestLimits rest_limits(const WorldSettings& world, double threshold);

/// The boundaries of a scene that are driven. `scene` must outlive it.
class DrivenBoundaries {
 public:
  DrivenBoundaries() = default;
  explicit DrivenBoundaries(const Scene& scene);
  /// Whether one that moves at time t [s] may come closer than `reach` to a box.
  bool near(const Bounds& box, double reach, double t) const;

 private:
  struct Driven {
    const Boundary* boundary = nullptr;
    double radius = 0;  ///< about the origin of its frame [m]
  };
  static double distance(const Driven& driven, const Pose& pose, const Bounds& box);
  std::vector<Driven> driven_;
};

}  // namespace moraine
