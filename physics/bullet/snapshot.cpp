// SPDX-License-Identifier: Apache-2.0
// A Bullet world to bytes and back: bodies with their exact matrices, contacts with their warm-start impulses, bonds.
#include <fmt/format.h>

#include "physics/bullet/impact_memory.hpp"
#include "physics/bullet/precision.hpp"
#include "physics/bullet/world.hpp"
#include "physics/bytes.hpp"

namespace moraine::bullet {
namespace {

constexpr std::uint32_t magic = is_double ? 0x4442574cU : 0x4d42574cU;  // "LWBD", "LWBM"
constexpr std::uint32_t version = 4;

struct BodyImage {
  std::uint32_t slot, id, shape, material;
  std::uint8_t role, carries;
  double mass;
  btScalar basis[9], origin[3], linear[3], angular[3];
};

void copy(const btVector3& v, btScalar* to) {
  for (int a = 0; a < 3; ++a) to[a] = v[a];
}
btVector3 vector(const btScalar* from) { return {from[0], from[1], from[2]}; }

struct PointImage {
  btScalar local_a[3], local_b[3], world_a[3], world_b[3], normal[3], dir1[3], dir2[3];
  btScalar distance, impact_overlap, impulse, lateral1, lateral2, motion1, motion2, friction, restitution;
  std::int32_t flags, lifetime, part0, part1, index0, index1;
};

PointImage image(const btManifoldPoint& p) {
  PointImage i{};
  copy(p.m_localPointA, i.local_a);
  copy(p.m_localPointB, i.local_b);
  copy(p.m_positionWorldOnA, i.world_a);
  copy(p.m_positionWorldOnB, i.world_b);
  copy(p.m_normalWorldOnB, i.normal);
  copy(p.m_lateralFrictionDir1, i.dir1);
  copy(p.m_lateralFrictionDir2, i.dir2);
  i.distance = p.m_distance1;
  i.impact_overlap = impact_overlap(p);
  i.impulse = p.m_appliedImpulse;
  i.lateral1 = p.m_appliedImpulseLateral1;
  i.lateral2 = p.m_appliedImpulseLateral2;
  i.motion1 = p.m_contactMotion1;
  i.motion2 = p.m_contactMotion2;
  i.friction = p.m_combinedFriction;
  i.restitution = p.m_combinedRestitution;
  i.flags = p.m_contactPointFlags;
  i.lifetime = p.m_lifeTime;
  i.part0 = p.m_partId0;
  i.part1 = p.m_partId1;
  i.index0 = p.m_index0;
  i.index1 = p.m_index1;
  return i;
}

btManifoldPoint point(const PointImage& i) {
  btManifoldPoint p(vector(i.local_a), vector(i.local_b), vector(i.normal), i.distance);
  p.m_positionWorldOnA = vector(i.world_a);
  p.m_positionWorldOnB = vector(i.world_b);
  p.m_lateralFrictionDir1 = vector(i.dir1);
  p.m_lateralFrictionDir2 = vector(i.dir2);
  set_impact_overlap(p, i.impact_overlap);
  p.m_appliedImpulse = i.impulse;
  p.m_appliedImpulseLateral1 = i.lateral1;
  p.m_appliedImpulseLateral2 = i.lateral2;
  p.m_contactMotion1 = i.motion1;
  p.m_contactMotion2 = i.motion2;
  p.m_combinedFriction = i.friction;
  p.m_combinedRestitution = i.restitution;
  p.m_contactPointFlags = i.flags;
  p.m_lifeTime = i.lifetime;
  p.m_partId0 = i.part0;
  p.m_partId1 = i.part1;
  p.m_index0 = i.index0;
  p.m_index1 = i.index1;
  return p;
}

/// A pair whose contacts sit in one manifold that the pair's algorithm owns from its first call; compounds have many.
bool one_manifold(const btCollisionObject* a, const btCollisionObject* b) {
  return !a->getCollisionShape()->isCompound() && !b->getCollisionShape()->isCompound();
}

}  // namespace

/// Which pairs are listed depends on when they were listed last; and contacts of compounds cannot be put back.
void BulletWorld::canonicalise() {
  broadphase_.list_now(&dispatcher_);
  broadphase_.forget_contacts(
      &dispatcher_, [](const btCollisionObject* a, const btCollisionObject* b) { return !one_manifold(a, b); });
}

void BulletWorld::save(std::vector<std::byte>& out) const {
  ByteWriter w(out);
  w.put(magic);
  w.put(version);
  std::vector<BodyImage> bodies;
  for (Slot slot = 0; slot < entries_.size(); ++slot) {
    const Entry& e = entry(slot);
    if (!e.body) continue;
    BodyImage b{};
    b.slot = slot;
    b.id = static_cast<std::uint32_t>(e.tag.key);
    b.shape = e.shape;
    b.material = e.tag.material;
    b.role = static_cast<std::uint8_t>(e.role);
    b.mass = e.mass;
    b.carries = e.tag.carries;
    const btTransform& pose = e.body->getWorldTransform();
    for (int row = 0; row < 3; ++row) copy(pose.getBasis()[row], b.basis + 3 * row);
    copy(pose.getOrigin(), b.origin);
    copy(e.body->getLinearVelocity(), b.linear);
    copy(e.body->getAngularVelocity(), b.angular);
    bodies.push_back(b);
  }
  w.put(time_);
  w.put(static_cast<std::uint64_t>(entries_.size()));
  w.put_all(std::span<const BodyImage>(bodies));
  w.put_all(std::span<const Slot>(free_slots_));
  save_contacts(w);
  save_bonds(w);
}

void BulletWorld::save_contacts(ByteWriter& w) const {
  std::uint64_t pairs = 0;
  broadphase_.each_contact_pair([&](btBroadphasePair&) { ++pairs; });
  w.put(pairs);
  broadphase_.each_contact_pair([&](btBroadphasePair& pair) {
    btManifoldArray manifolds;
    pair.m_algorithm->getAllContactManifolds(manifolds);
    std::vector<PointImage> points;
    for (int k = 0; manifolds.size() > 0 && k < manifolds[0]->getNumContacts(); ++k)
      points.push_back(image(manifolds[0]->getContactPoint(k)));
    w.put(tag(pair.m_pProxy0).key);
    w.put(tag(pair.m_pProxy1).key);
    w.put_all(std::span<const PointImage>(points));
  });
}

void BulletWorld::save_bonds(ByteWriter& w) const {
  w.put(static_cast<std::uint64_t>(bonds_.springs().size()));
  for (const BondSpring& s : bonds_.springs()) {
    w.put(s.bond);
    w.put(slot_of(s.a));
    w.put(slot_of(s.b));
    w.put(s.impulse);
  }
}

void BulletWorld::load(std::span<const std::byte> in) {
  ByteReader r(in);
  if (r.get<std::uint32_t>() != magic || r.get<std::uint32_t>() != version)
    throw IoError(fmt::format("saved state is not of this version of engine {}", engine_name));
  clear();
  time_ = r.get<double>();
  move_boundaries(time_);
  entries_.resize(r.get<std::uint64_t>());
  for (auto& e : entries_) e = std::make_unique<Entry>();
  std::vector<BodyImage> bodies;
  r.get_all(bodies);
  for (const BodyImage& b : bodies) {
    place(b.slot, {b.id, b.shape, b.material, b.mass, static_cast<Role>(b.role), {}, b.carries != 0});
    btRigidBody& body = *entry(b.slot).body;
    const btMatrix3x3 basis(b.basis[0], b.basis[1], b.basis[2], b.basis[3], b.basis[4], b.basis[5], b.basis[6],
                            b.basis[7], b.basis[8]);
    body.setCenterOfMassTransform(btTransform(basis, vector(b.origin)));
    body.setLinearVelocity(vector(b.linear));
    body.setAngularVelocity(vector(b.angular));
  }
  r.get_all(free_slots_);
  load_contacts(r);
  load_bonds(r);
}

/// Lets Bullet make each pair's algorithm and manifold by running its narrow phase, then puts the saved points back.
void BulletWorld::load_contacts(ByteReader& r) {
  use_pair_laws();
  broadphase_.list_now(&dispatcher_);
  const auto pairs = r.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < pairs; ++i) {
    const auto key_a = r.get<std::uint64_t>();
    const auto key_b = r.get<std::uint64_t>();
    std::vector<PointImage> points;
    r.get_all(points);
    btBroadphasePair* pair = broadphase_.find(key_a, key_b);
    if (!pair) throw IoError("saved state holds a contact between bodies that are far apart");
    btPersistentManifold& manifold = make_manifold(*pair);
    manifold.clearManifold();
    for (const PointImage& p : points) manifold.addManifoldPoint(point(p));
  }
}

btPersistentManifold& BulletWorld::make_manifold(btBroadphasePair& pair) {
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher_, dynamics_.getDispatchInfo());
  btManifoldArray manifolds;
  pair.m_algorithm->getAllContactManifolds(manifolds);
  if (manifolds.size() != 1) throw IoError("saved state does not fit the engine's contact layout");
  return *manifolds[0];
}

void BulletWorld::load_bonds(ByteReader& r) {
  const auto count = r.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto bond = r.get<std::uint32_t>();
    const auto a = r.get<Slot>();
    const auto b = r.get<Slot>();
    add_bond(bond, a, b);
    bonds_.springs().back().impulse = r.get<btScalar>();
  }
}

}  // namespace moraine::bullet
