// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/bodies.hpp"

#include <cmath>

namespace moraine::impulse {
namespace {

/// Turns the quaternion q by the rotation vector 2 `half`, world frame, and keeps its length. The series is exact to
/// float32 up to turns of 0.2.
void rotate(Vec& q, const Vec& half) {
  const float a = half.squaredNorm();
  float s = 1 - a / 6, c = 1 - a / 2 + a * a / 24;
  if (a > 0.01F) {
    const float angle = std::sqrt(a);
    s = std::sin(angle) / angle;
    c = std::cos(angle);
  }
  const Vec turned = c * q + s * (q.w() * half + half.cross3(q)) - Vec(0, 0, 0, s * half.dot(q));
  q = (1.5F - 0.5F * turned.squaredNorm()) * turned;
}

}  // namespace

Slot Bodies::add(const Body& body, const Shape& shape) {
  const Slot slot = roster.add(body.id);
  const auto radius = static_cast<float>(shape.sphere()->radius / units_.length);
  position.push_back({0, 0, 0, radius});
  moving.emplace_back();
  weight.push_back({0, body.material});
  attitude.emplace_back();
  ghost.push_back(body.role == Role::ghost);
  set_mass(place(slot), body.mass);
  whole.push_back(weight.back().inverse_mass);
  set_state(place(slot), body.state);
  return slot;
}

void Bodies::set_state(Place p, const ElementState& state) {
  position[p].head<3>() = units_.position(state.pose.position).head<3>();
  attitude[p] = state.pose.orientation.coeffs().cast<float>();
  moving[p].velocity = narrow(state.twist.linear / units_.velocity());
  moving[p].turning = narrow(si_radius(p) / units_.velocity() * state.twist.angular);
}

Quat Bodies::orientation(Place p) const {
  const Eigen::Vector4d q = attitude[p].cast<double>();
  return Quat(q.w(), q.x(), q.y(), q.z()).normalized();
}

Twist Bodies::twist(Place p) const {
  return {units_.velocity() * wide(moving[p].velocity), units_.velocity() / si_radius(p) * wide(moving[p].turning)};
}

/// Radius times angular velocity changes by 5/2 of the angular impulse per mass and radius: a solid sphere.
void Bodies::push(Place p, const Impulse& impulse) {
  const float inverse_mass = weight[p].inverse_mass;
  moving[p].velocity += inverse_mass * narrow(impulse.linear / units_.momentum());
  moving[p].turning += 2.5F * inverse_mass * narrow(impulse.angular / (units_.momentum() * si_radius(p)));
}

void Bodies::settle() {
  roster.settle();
  native::reorder(position, roster.order());
  native::reorder(moving, roster.order());
  native::reorder(weight, roster.order());
  native::reorder(attitude, roster.order());
  native::reorder(ghost, roster.order());
  native::reorder(whole, roster.order());
}

void Bodies::advance(float h, bool turn) {
  for (Place p = 0; p < size(); ++p) position[p] += h * moving[p].velocity;
  if (!turn) return;
  for (Place p = 0; p < size(); ++p)
    if (!moving[p].turning.isZero(0)) rotate(attitude[p], 0.5F * h / radius(p) * moving[p].turning);
}

}  // namespace moraine::impulse
