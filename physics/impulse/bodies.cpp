// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/bodies.hpp"

#include "physics/impulse/pair_kernels.hpp"
#include "physics/native/room.hpp"

namespace moraine::impulse {

using native::append;

Slot Bodies::add(const Body& body, const Shape& shape) {
  const Slot slot = roster.add(body.id);
  const auto radius = static_cast<float>(shape.sphere()->radius / units_.length);
  append(position, Vec(0, 0, 0, radius));
  append(moving, Moving{});
  append(material, body.material);
  append(attitude, Vec());
  append(ghost, std::uint8_t{body.role == Role::ghost});
  append(carries, std::uint8_t{0});
  set_mass(place(slot), body.mass, body.carries);
  set_state(place(slot), body.state);
  return slot;
}

void Bodies::set_state(Place p, const ElementState& state) {
  position[p].head<3>() = units_.position(state.pose.position).head<3>();
  attitude[p] = state.pose.orientation.coeffs().cast<float>();
  moving[p].velocity = narrow(state.twist.linear / units_.velocity());
  moving[p].turning.head<3>() = narrow(si_radius(p) / units_.velocity() * state.twist.angular).head<3>();
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
  const float inverse_mass = moving[p].inverse_mass();
  moving[p].velocity += inverse_mass * narrow(impulse.linear / units_.momentum());
  moving[p].turning += 2.5F * inverse_mass * narrow(impulse.angular / (units_.momentum() * si_radius(p)));
}

void Bodies::settle() {
  roster.settle();
  native::reorder(position, roster.order());
  native::reorder(moving, roster.order());
  native::reorder(material, roster.order());
  native::reorder(attitude, roster.order());
  native::reorder(ghost, roster.order());
  native::reorder(carries, roster.order());
}

void Bodies::fall(const Vec& change, bool remember) {
  if (remember) {
    before.resize(size());
    for (Place p = 0; p < size(); ++p) before[p] = moving[p].velocity;
  }
  for (Moving& m : moving) m.velocity += change;
}

void Bodies::advance(float h, bool turn) {
  if (size() == 0) return;
  pair_kernels().advance(
      {position.data()->data(), moving.data()->velocity.data(), attitude.data()->data(), size(), h, turn});
}

}  // namespace moraine::impulse
