// SPDX-License-Identifier: Apache-2.0
#include "physics/ode/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::ode {
namespace {

std::array<double, 3> numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

bool finite(const Record& r) {
  const auto all = [](const auto& a) {
    return std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); });
  };
  return all(r.position) && all(r.velocity) && all(r.spin) && all(r.orientation);
}

void copy(const dReal* from, std::array<double, 3>& to) { std::copy(from, from + 3, to.begin()); }

}  // namespace

Bodies::~Bodies() {
  for (Handle& h : handles_) {
    h.parts.clear();
    dBodyDestroy(h.body);
  }
}

Slot Bodies::add(const Body& body) {
  const Slot slot = roster.add(body.id);
  Record& r = records.emplace_back();
  r.mass = body.mass / units_.mass;
  r.shape = body.shape;
  r.material = body.material;
  r.ghost = body.role == Role::ghost;
  ghost.push_back(r.ghost != 0);
  set_state(place(slot), body.state);
  return slot;
}

void Bodies::set_state(Place p, const ElementState& state) {
  Record& r = records[p];
  const Quat& q = state.pose.orientation;
  r.position = numbers(units_.position(state.pose.position));
  r.orientation = {q.w(), q.x(), q.y(), q.z()};
  r.velocity = numbers(state.twist.linear / units_.velocity());
  r.spin = numbers(state.twist.angular * units_.time);
}

Quat Bodies::orientation(Place p) const {
  const auto& q = records[p].orientation;
  return Quat(q[0], q[1], q[2], q[3]);
}

Twist Bodies::twist(Place p) const {
  return {units_.velocity() * vec(records[p].velocity.data()), vec(records[p].spin.data()) / units_.time};
}

void Bodies::push(Place p, const Impulse& impulse) {
  Record& r = records[p];
  const Quat q = orientation(p);
  const Vec3 turn = q.conjugate() * Vec3(impulse.angular / (units_.momentum() * units_.length));
  r.velocity = numbers(vec(r.velocity.data()) + impulse.linear / (units_.momentum() * r.mass));
  r.spin = numbers(vec(r.spin.data()) + q * Vec3(turn.cwiseQuotient(inertia(p))));
}

/// Only the number of ODE's bodies follows: each is given its place's shape,
/// mass and state.
void Bodies::settle() {
  roster.settle();
  native::reorder(records, roster.order());
  native::reorder(ghost, roster.order());
  for (; handles_.size() > size(); handles_.pop_back()) {
    handles_.back().parts.clear();
    dBodyDestroy(handles_.back().body);
  }
  while (handles_.size() < size()) handles_.push_back({dBodyCreate(world_), ~0U, 0, {}});
}

void Bodies::fit(Place p) {
  Handle& h = handles_[p];
  const Record& r = records[p];
  if (h.shape == r.shape && h.mass == r.mass) return;
  if (h.shape != r.shape) {
    h.parts = make_parts(shape(p).geometry, 1 / units_.length, h.body);
    dBodySetGyroscopicMode(h.body, shape(p).sphere() == nullptr);
  }
  dMass mass;
  const Vec3 i = inertia(p);
  dMassSetParameters(&mass, r.mass, 0, 0, 0, i.x(), i.y(), i.z(), 0, 0, 0);
  dBodySetMass(h.body, &mass);
  h.shape = r.shape;
  h.mass = r.mass;
}

void Bodies::upload() {
  sound_.resize(size());
  for (Place p = 0; p < size(); ++p) {
    const Record& r = records[p];
    const dBodyID b = handles_[p].body;
    sound_[p] = finite(r);
    if (!sound(p)) {
      dBodyDisable(b);
      continue;
    }
    fit(p);
    dBodyEnable(b);
    dBodySetPosition(b, r.position[0], r.position[1], r.position[2]);
    dBodySetQuaternion(b, r.orientation.data());
    dBodySetLinearVel(b, r.velocity[0], r.velocity[1], r.velocity[2]);
    dBodySetAngularVel(b, r.spin[0], r.spin[1], r.spin[2]);
  }
}

void Bodies::download() {
  for (Place p = 0; p < size(); ++p) {
    if (!sound(p)) continue;
    Record& r = records[p];
    const dBodyID b = handles_[p].body;
    copy(dBodyGetPosition(b), r.position);
    copy(dBodyGetLinearVel(b), r.velocity);
    copy(dBodyGetAngularVel(b), r.spin);
    std::copy(dBodyGetQuaternion(b), dBodyGetQuaternion(b) + 4, r.orientation.begin());
  }
}

}  // namespace moraine::ode
