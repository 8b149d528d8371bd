// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "physics/bullet/precision.hpp"
#include "physics/bullet/settings.hpp"

namespace moraine::bullet {
namespace {

int group_of(Role role) { return role == Role::real ? real_group : ghost_group; }
/// Ghosts meet real elements only: their contacts with ghosts and boundaries live in the owner's world.
int mask_of(Role role) { return role == Role::real ? real_group | ghost_group | boundary_group : real_group; }

/// Bullet hands these callbacks two bodies and no context, so each step says whose table holds on this thread.
thread_local const MaterialTable* active_materials = nullptr;

const PairLaw& law(const btCollisionObject* a, const btCollisionObject* b) {
  return active_materials->pair(tag(a).material, tag(b).material);
}

btScalar pair_friction(const btCollisionObject* a, const btCollisionObject* b) {
  return static_cast<btScalar>(law(a, b).friction);
}

btScalar pair_restitution(const btCollisionObject* a, const btCollisionObject* b) {
  return static_cast<btScalar>(law(a, b).restitution);
}

/// Bullet's documented hooks for pair values are process-wide; by default it multiplies the two bodies' numbers.
void install_pair_laws() {
  static std::once_flag once;
  std::call_once(once, [] {
    gCalculateCombinedFrictionCallback = pair_friction;
    gCalculateCombinedRestitutionCallback = pair_restitution;
  });
}

Vec3 point_impulse(const btManifoldPoint& p) {
  return Units::raw(p.m_normalWorldOnB * p.m_appliedImpulse + p.m_lateralFrictionDir1 * p.m_appliedImpulseLateral1 +
                    p.m_lateralFrictionDir2 * p.m_appliedImpulseLateral2);
}

}  // namespace

BulletWorld::BulletWorld(const WorldSettings& settings, const Vec3& origin)
    : settings_(settings),
      units_(settings, origin),
      configuration_(make_configuration()),
      dispatcher_(configuration_.get()),
      sphere_contacts_(static_cast<btScalar>(settings.overlap_recovery)),
      dynamics_(&dispatcher_, &broadphase_, &bonds_, configuration_.get()) {
  install_pair_laws();
  dispatcher_.registerCollisionCreateFunc(SPHERE_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE, &sphere_contacts_);
  apply_world_settings(dynamics_, settings_);
  add_boundaries();
}

BulletWorld::~BulletWorld() { broadphase_.release_all(&dispatcher_); }

void BulletWorld::check_limits() const {
  const std::size_t count = bodies_ + boundaries_.size() + 1;
  if (count > settings_.limits.elements)
    throw InputError(
        fmt::format("engine {}: {} elements, ghosts and boundaries in one sub-model, the limit is {}; "
                    "use more sub-models",
                    engine_name, count, settings_.limits.elements));
}

Slot BulletWorld::free_slot() {
  if (free_slots_.empty()) {
    entries_.push_back(std::make_unique<Entry>());
    return static_cast<Slot>(entries_.size() - 1);
  }
  const Slot slot = free_slots_.back();
  free_slots_.pop_back();
  return slot;
}

Slot BulletWorld::add(const Body& body) {
  check_limits();
  const Slot slot = free_slot();
  place(slot, body);
  return slot;
}

void BulletWorld::place(Slot slot, const Body& body) {
  Entry& e = entry(slot);
  const Shape& s = settings_.scene->shapes[body.shape];
  e.tag = {body.id, body.material, static_cast<btScalar>(s.bounding_radius / units_.length), s.sphere() != nullptr};
  e.shape = body.shape;
  e.role = body.role;
  e.mass = body.mass;
  e.tag.carries = body.carries;
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(body.mass / units_.mass), nullptr,
                                                shape(body.shape), inertia(body.shape, body.mass));
  e.body = std::make_unique<btRigidBody>(info);
  e.body->setUserPointer(&e.tag);
  e.body->setUserIndex(static_cast<int>(slot));
  apply_body_settings(*e.body, e.tag.spherical);
  set_state(slot, body.state);
  dynamics_.addRigidBody(e.body.get(), group_of(body.role), mask_of(body.role));
  ++bodies_;
}

void BulletWorld::remove(Slot slot) {
  Entry& e = entry(slot);
  dynamics_.removeRigidBody(e.body.get());
  e.body.reset();
  free_slots_.push_back(slot);
  --bodies_;
}

void BulletWorld::set_state(Slot slot, const ElementState& state) {
  btRigidBody& body = *entry(slot).body;
  // With the inertia, also a sphere's: it turns by rounding, which a saved world must not remember.
  body.setCenterOfMassTransform(units_.pose(state.pose));
  body.setLinearVelocity(Units::raw(Vec3(state.twist.linear / units_.velocity())));
  body.setAngularVelocity(Units::raw(Vec3(state.twist.angular * units_.time)));
}

ElementState BulletWorld::state(Slot slot) const {
  const btRigidBody& body = *entry(slot).body;
  return {
      units_.pose(body.getWorldTransform()),
      {Units::raw(body.getLinearVelocity()) * units_.velocity(), Units::raw(body.getAngularVelocity()) / units_.time}};
}

Vec3 BulletWorld::position(Slot slot) const {
  return units_.position(entry(slot).body->getWorldTransform().getOrigin());
}

void BulletWorld::motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const {
  out.resize(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const btRigidBody& body = *entry(slots[i]).body;
    out[i] = {units_.position(body.getWorldTransform().getOrigin()),
              {Units::raw(body.getLinearVelocity()) * units_.velocity(),
               Units::raw(body.getAngularVelocity()) / units_.time}};
  }
}

btVector3 BulletWorld::inertia(std::uint32_t shape, double mass) const {
  const Vec3 per_mass = settings_.scene->shapes[shape].inertia_per_mass / (units_.length * units_.length);
  return Units::raw(Vec3(per_mass * (mass / units_.mass)));
}

void BulletWorld::set_mass(Slot slot, double mass, bool carries) {
  Entry& e = entry(slot);
  e.tag.carries = carries;
  if (e.mass == mass) return;
  e.mass = mass;
  e.body->setMassProps(static_cast<btScalar>(mass / units_.mass), inertia(e.shape, mass));
  e.body->setGravity(dynamics_.getGravity());  // Bullet keeps gravity as a force, which scales with the mass
  e.body->updateInertiaTensor();
}

void BulletWorld::apply_impulse(Slot slot, const Impulse& impulse) {
  btRigidBody& body = *entry(slot).body;
  body.applyCentralImpulse(Units::raw(Vec3(impulse.linear / units_.momentum())));
  body.applyTorqueImpulse(Units::raw(Vec3(impulse.angular / (units_.momentum() * units_.length))));
}

void BulletWorld::add_bond(std::uint32_t bond, Slot a, Slot b) {
  const Bond& s = settings_.scene->bonds[bond];
  const double stiffness = units_.mass / (units_.time * units_.time);
  bonds_.add({bond, entry(a).body.get(), entry(b).body.get(), static_cast<btScalar>(s.rest_length / units_.length),
              static_cast<btScalar>(s.stiffness / stiffness),
              static_cast<btScalar>(s.damping / (stiffness * units_.time)),
              static_cast<btScalar>(s.break_length / units_.length), 0});
}

void BulletWorld::use_pair_laws() const { active_materials = &settings_.scene->materials; }

void BulletWorld::clear() {
  broadphase_.release_all(&dispatcher_);
  for (auto& e : entries_)
    if (e->body) dynamics_.removeRigidBody(e->body.get());
  entries_.clear();
  free_slots_.clear();
  bonds_.clear();
  bodies_ = 0;
}

void BulletWorld::step(double t) {
  use_pair_laws();
  time_ = t;
  move_boundaries(t);
  dynamics_.stepSimulation(static_cast<btScalar>(settings_.substep / units_.time), 0);
  sum_boundary_impulse();
}

/// Of a driven boundary's surface, as the solver sees it.
Vec3 BulletWorld::boundary_velocity(std::size_t boundary, const Vec3& point) const {
  const btRigidBody& body = *boundaries_[boundary]->body;
  const Vec3 arm = point - units_.position(body.getWorldTransform().getOrigin());
  const Vec3 spin = Units::raw(body.getAngularVelocity()) / units_.time;
  return Units::raw(body.getLinearVelocity()) * units_.velocity() + spin.cross(arm);
}

/// Reaction of the boundaries on real elements; contacts with boundaries have the boundary as second body.
void BulletWorld::sum_boundary_impulse() {
  boundary_impulse_ = {};
  boundary_work_ = 0;
  broadphase_.each_contact_pair([&](btBroadphasePair& pair) {
    if (!tag(pair.m_pProxy1).is_boundary()) return;
    btManifoldArray manifolds;
    pair.m_algorithm->getAllContactManifolds(manifolds);
    for (int i = 0; i < manifolds.size(); ++i)
      for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) {
        const Contact c = contact(*manifolds[i], manifolds[i]->getContactPoint(k));
        boundary_impulse_ += {c.impulse, c.point.cross(c.impulse)};
        if (boundaries_[c.b]->body->isKinematicObject())
          boundary_work_ += c.impulse.dot(boundary_velocity(c.b, c.point));
      }
  });
}

/// A pair's bodies may reach the manifold in either order; a is always the element with the lower id.
Contact BulletWorld::contact(const btPersistentManifold& manifold, const btManifoldPoint& p) const {
  const BodyTag& first = tag(manifold.getBody0());
  const BodyTag& second = tag(manifold.getBody1());
  const bool swapped = second.key < first.key;
  const double sign = swapped ? -1 : 1;
  Contact c;
  c.a = static_cast<ElementId>((swapped ? second : first).key);
  c.b = static_cast<ElementId>((swapped ? first : second).key);
  c.with_boundary = (swapped ? first : second).is_boundary();
  c.point = units_.position(swapped ? p.getPositionWorldOnB() : p.getPositionWorldOnA());
  c.normal = sign * Units::raw(p.m_normalWorldOnB);
  c.overlap = -p.getDistance() * units_.length;
  c.impulse = sign * units_.momentum() * point_impulse(p);
  return c;
}

std::vector<Contact> BulletWorld::contacts() const {
  btManifoldArray manifolds;
  broadphase_.collect_manifolds(manifolds);
  std::vector<Contact> out;
  for (int i = 0; i < manifolds.size(); ++i)
    for (int k = 0; k < manifolds[i]->getNumContacts(); ++k)
      out.push_back(contact(*manifolds[i], manifolds[i]->getContactPoint(k)));
  return out;
}

StepWork BulletWorld::work() const {
  return {bodies_, static_cast<std::uint64_t>(dynamics_.manifold_count()), bonds_.springs().size()};
}

}  // namespace moraine::bullet
