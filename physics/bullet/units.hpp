// SPDX-License-Identifier: Apache-2.0
// Between SI in the world frame and Bullet's scaled, local float32 numbers.
#pragma once

#include <LinearMath/btTransform.h>

#include "physics/types.hpp"
#include "physics/world.hpp"

namespace moraine::bullet {

/// A typical element has diameter 1 and mass 1, and falls its own diameter in about one unit of time. Positions are
/// relative to the sub-model's origin, so float32 keeps 1e-6 diameters however far the sub-model lies from the scene's.
class Units {
 public:
  Units(const WorldSettings& s, const Vec3& origin)
      : length(s.length_unit), time(s.time_unit), mass(s.mass_unit), origin_(origin) {}

  const double length, time, mass;
  double velocity() const { return length / time; }
  double momentum() const { return mass * length / time; }

  static btVector3 raw(const Vec3& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
  }
  static Vec3 raw(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

  static btQuaternion raw(const Quat& q) {
    return {static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()), static_cast<btScalar>(q.z()),
            static_cast<btScalar>(q.w())};
  }

  btVector3 position(const Vec3& p) const { return raw(Vec3((p - origin_) / length)); }
  Vec3 position(const btVector3& p) const { return origin_ + raw(p) * length; }
  btVector3 extent(const Vec3& e) const { return raw(Vec3(e / length)); }

  btTransform pose(const Pose& p) const { return btTransform(raw(p.orientation), position(p.position)); }
  Pose pose(const btTransform& t) const {
    const btQuaternion q = t.getRotation();
    return {position(t.getOrigin()), Quat(q.w(), q.x(), q.y(), q.z()).normalized()};
  }

 private:
  Vec3 origin_;
};

}  // namespace moraine::bullet
