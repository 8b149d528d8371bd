// SPDX-License-Identifier: Apache-2.0
// Vectors, poses and ids shared by everything that knows physics. SI units, world frame, doubles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

namespace moraine {

using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;

/// An element's name for life: unique in the scene, the key of every sum and of every tie.
using ElementId = std::uint32_t;
/// A sub-model's number, 0 .. count-1.
using SubModelId = std::uint32_t;

struct Pose {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
};

/// Linear [m/s] and angular [rad/s] velocity of a body about its centre of mass.
struct Twist {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();

  Twist& operator+=(const Twist& o) {
    linear += o.linear;
    angular += o.angular;
    return *this;
  }
};
inline Twist operator+(Twist a, const Twist& b) { return a += b; }
inline Twist operator*(double s, const Twist& t) { return {s * t.linear, s * t.angular}; }

/// Linear [N s] and angular [N m s] impulse about a body's centre of mass.
struct Impulse {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();

  Impulse& operator+=(const Impulse& o) {
    linear += o.linear;
    angular += o.angular;
    return *this;
  }
};

/// Where an element is and how it moves.
struct ElementState {
  Pose pose;
  Twist twist;
};

/// An axis-aligned box; empty (inverted) until something is added.
struct Bounds {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return (min.array() > max.array()).any(); }
  void add(const Vec3& p, double radius = 0.0) {
    min = min.cwiseMin(p.array().matrix() - Vec3::Constant(radius));
    max = max.cwiseMax(p.array().matrix() + Vec3::Constant(radius));
  }
  void add(const Bounds& o) {
    min = min.cwiseMin(o.min);
    max = max.cwiseMax(o.max);
  }
  Bounds inflated(double by) const { return {min - Vec3::Constant(by), max + Vec3::Constant(by)}; }
  bool overlaps(const Bounds& o) const {
    return (min.array() <= o.max.array()).all() && (o.min.array() <= max.array()).all();
  }
  /// Distance from a point to the farthest corner [m].
  double farthest(const Vec3& p) const { return (max - p).cwiseAbs().cwiseMax((p - min).cwiseAbs()).norm(); }
  /// Distance from a point to the box [m]; 0 inside.
  double distance(const Vec3& p) const { return beyond(p).norm(); }
  /// Whether a point is that close to the box [m].
  bool within(double reach, const Vec3& p) const { return beyond(p).squaredNorm() <= reach * reach; }

 private:
  Vec3 beyond(const Vec3& p) const { return (min - p).cwiseMax(p - max).cwiseMax(Vec3::Zero()); }
};

}  // namespace moraine
