// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/sphere_contact.hpp"

#include <new>

namespace moraine::bullet {
namespace {

// A contact is kept, with its impulses, up to this gap [sum of radii]; Bullet's own threshold for spheres.
constexpr btScalar keep_gap = 0.01F;
constexpr btScalar at_limit = 0.999F;  // friction impulses, squared, from here on are those of a sliding contact

btScalar radius(const btCollisionObjectWrapper* o) {
  return static_cast<const btSphereShape*>(o->getCollisionShape())->getRadius();
}

btManifoldPoint fresh_point(const btCollisionObject* a, const btCollisionObject* b) {
  const btVector3 zero(0, 0, 0);
  btManifoldPoint p(zero, zero, zero, 0);
  p.m_partId0 = p.m_partId1 = p.m_index0 = p.m_index1 = 0;
  p.m_positionWorldOnA = p.m_positionWorldOnB = zero;
  p.m_combinedFriction = gCalculateCombinedFrictionCallback(a, b);
  p.m_combinedRestitution = gCalculateCombinedRestitutionCallback(a, b);
  p.m_combinedRollingFriction = 0;
  p.m_combinedSpinningFriction = 0;
  return p;
}

/// Turns the cached friction directions with the normal, so that the kept impulses stay tangential.
void turn_directions(btManifoldPoint& p, const btVector3& normal) {
  if (!(p.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED)) return;
  btVector3 along = p.m_lateralFrictionDir1 - normal * normal.dot(p.m_lateralFrictionDir1);
  const btScalar length2 = along.length2();
  if (length2 < btScalar(0.25)) {  // the normal has swung over: begin anew
    p.m_contactPointFlags &= ~BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
    p.m_appliedImpulseLateral1 = p.m_appliedImpulseLateral2 = 0;
    return;
  }
  p.m_lateralFrictionDir1 = along / btSqrt(length2);
  p.m_lateralFrictionDir2 = normal.cross(p.m_lateralFrictionDir1);
}

/// Whether the last step's friction was less than friction can be.
bool sticks(const btManifoldPoint& p) {
  const btScalar limit = p.m_combinedFriction * p.m_appliedImpulse;
  const btScalar s = p.m_appliedImpulseLateral1, t = p.m_appliedImpulseLateral2;
  return (p.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) &&
         s * s + t * t < at_limit * limit * limit;
}

/// The local points were at one place a step ago; what lies between them now is the slip since, to be taken back.
void aim_back(btManifoldPoint& p, const btTransform& a, const btTransform& b, btScalar rate) {
  if (!sticks(p)) {
    p.m_contactMotion1 = p.m_contactMotion2 = 0;
    return;
  }
  const btVector3 slip = a * p.m_localPointA - b * p.m_localPointB;
  p.m_contactMotion1 -= rate * slip.dot(p.m_lateralFrictionDir1);
  p.m_contactMotion2 -= rate * slip.dot(p.m_lateralFrictionDir2);
}

}  // namespace

SphereContact::SphereContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                             const btCollisionObjectWrapper* b, btScalar slip_recovery)
    : btCollisionAlgorithm(info),
      slip_recovery_(slip_recovery),
      manifold_(info.m_dispatcher1->getNewManifold(a->getCollisionObject(), b->getCollisionObject())) {}

SphereContact::~SphereContact() { m_dispatcher->releaseManifold(manifold_); }

void SphereContact::processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                                     const btDispatcherInfo& info, btManifoldResult*) {
  const btTransform& pose_a = a->getWorldTransform();
  const btTransform& pose_b = b->getWorldTransform();
  const btVector3& xa = pose_a.getOrigin();
  const btVector3& xb = pose_b.getOrigin();
  const btScalar ra = radius(a), rb = radius(b);
  const btVector3 apart = xa - xb;
  const btScalar distance = apart.length();
  const btScalar gap = distance - (ra + rb);
  const bool known = manifold_->getNumContacts() > 0;
  if (gap > (known ? keep_gap * (ra + rb) : btScalar(0))) {
    manifold_->clearManifold();
    return;
  }
  // Identical centres: any direction will do, as long as it is always the same.
  const btVector3 normal = distance > SIMD_EPSILON ? apart / distance : btVector3(1, 0, 0);
  if (!known) manifold_->addManifoldPoint(fresh_point(a->getCollisionObject(), b->getCollisionObject()));
  btManifoldPoint& p = manifold_->getContactPoint(0);
  turn_directions(p, normal);
  p.m_normalWorldOnB = normal;
  p.m_distance1 = gap;
  if (known) aim_back(p, pose_a, pose_b, slip_recovery_ / info.m_timeStep);
  p.m_positionWorldOnA = p.m_positionWorldOnB = xb + normal * (rb + gap / 2);
  p.m_localPointA = pose_a.invXform(p.m_positionWorldOnA);
  p.m_localPointB = pose_b.invXform(p.m_positionWorldOnB);
}

btCollisionAlgorithm* SphereContact::Maker::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                     const btCollisionObjectWrapper* a,
                                                                     const btCollisionObjectWrapper* b) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(SphereContact));
  return new (memory) SphereContact(info, a, b, slip_recovery);
}

}  // namespace moraine::bullet
