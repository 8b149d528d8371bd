// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/broadphase.hpp"

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include <algorithm>

namespace moraine::bullet {
namespace {

// Gap below which a pair is listed as a candidate [element diameters]. Larger: longer lists, rarer searches.
constexpr btScalar skin = 0.15F;
// Bullet keeps contacts up to this gap [element diameters]; boxes are tested this much wider.
constexpr btScalar contact_reach = 0.02F;

std::uint64_t key(const btBroadphaseProxy* proxy) { return tag(proxy).key; }

bool is_plane(const btCollisionObject& o) { return o.getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE; }
bool is_mesh(const btCollisionObject& o) { return o.getCollisionShape()->isConcave() && !is_plane(o); }

/// Height of the element's centre above a plane boundary.
btScalar height(const btCollisionObject& plane, const btVector3& centre) {
  const auto& shape = static_cast<const btStaticPlaneShape&>(*plane.getCollisionShape());
  const btTransform& pose = plane.getWorldTransform();
  const btVector3 normal = pose.getBasis() * shape.getPlaneNormal();
  return normal.dot(centre - pose.getOrigin()) - shape.getPlaneConstant();
}

bool boxes_overlap(const btBroadphaseProxy& p, const btBroadphaseProxy& q) {
  return TestAabbAgainstAabb2(p.m_aabbMin, p.m_aabbMax, q.m_aabbMin, q.m_aabbMax);
}

void update_box(btBroadphaseProxy& proxy) {
  const btCollisionObject& o = *Broadphase::object(&proxy);
  o.getCollisionShape()->getAabb(o.getWorldTransform(), proxy.m_aabbMin, proxy.m_aabbMax);
  const btVector3 reach(contact_reach, contact_reach, contact_reach);
  proxy.m_aabbMin -= reach;
  proxy.m_aabbMax += reach;
}

/// Finds out whether any triangle's box meets the query box.
struct AnyTriangle final : btTriangleCallback {
  bool found = false;
  void processTriangle(btVector3*, int, int) override { found = true; }
};

bool near_mesh(const btCollisionObject& mesh, const btVector3& centre, btScalar reach) {
  const btVector3 local = mesh.getWorldTransform().invXform(centre);
  const btVector3 half(reach, reach, reach);
  AnyTriangle any;
  static_cast<const btConcaveShape*>(mesh.getCollisionShape())->processAllTriangles(&any, local - half, local + half);
  return any.found;
}

/// Bounds how far any point of a boundary has moved since it had the pose `then`.
btScalar boundary_motion(const btCollisionObject& o, const btTransform& then) {
  if (!o.isKinematicObject()) return 0;
  btScalar turned = 0;
  for (int row = 0; row < 3; ++row) turned += (o.getWorldTransform().getBasis()[row] - then.getBasis()[row]).length2();
  const btScalar shift = (o.getWorldTransform().getOrigin() - then.getOrigin()).length();
  return shift + (turned > 0 ? btSqrt(turned) * o.getCollisionShape()->getAngularMotionDisc() : btScalar(0));
}

bool near_box(const btCollisionObject& solid, const btVector3& centre, btScalar reach) {
  btVector3 low, high;
  solid.getCollisionShape()->getAabb(solid.getWorldTransform(), low, high);
  const btVector3 half(reach, reach, reach);
  return TestAabbAgainstAabb2(low, high, centre - half, centre + half);
}

bool has_contacts(btBroadphasePair& pair, btManifoldArray& scratch) {
  scratch.resize(0);
  pair.m_algorithm->getAllContactManifolds(scratch);
  for (int i = 0; i < scratch.size(); ++i)
    if (scratch[i]->getNumContacts() > 0) return true;
  return false;
}

}  // namespace

Broadphase::Broadphase() = default;

Broadphase::~Broadphase() {
  for (btBroadphaseProxy* p : bodies_) delete p;
  for (btBroadphaseProxy* p : removed_) delete p;
}

btBroadphaseProxy* Broadphase::createProxy(const btVector3& low, const btVector3& high, int, void* user, int group,
                                           int mask, btDispatcher*) {
  bodies_.push_back(new btBroadphaseProxy(low, high, user, group, mask));
  changed_ = true;
  return bodies_.back();
}

/// The proxy stays until the next listing, marked by having no object; its pairs are released then.
void Broadphase::destroyProxy(btBroadphaseProxy* proxy, btDispatcher*) {
  proxy->m_clientObject = nullptr;
  changed_ = true;
}

void Broadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high, btDispatcher*) {
  proxy->m_aabbMin = low;
  proxy->m_aabbMax = high;
}

void Broadphase::getAabb(btBroadphaseProxy* proxy, btVector3& low, btVector3& high) const {
  low = proxy->m_aabbMin;
  high = proxy->m_aabbMax;
}

void Broadphase::rayTest(const btVector3&, const btVector3&, btBroadphaseRayCallback& callback, const btVector3&,
                         const btVector3&) {
  for (const btBroadphaseProxy* p : bodies_)
    if (object(p)) callback.process(p);
}

void Broadphase::aabbTest(const btVector3& low, const btVector3& high, btBroadphaseAabbCallback& callback) {
  for (const btBroadphaseProxy* p : bodies_)
    if (object(p) && TestAabbAgainstAabb2(low, high, p->m_aabbMin, p->m_aabbMax)) callback.process(p);
}

void Broadphase::getBroadphaseAabb(btVector3& low, btVector3& high) const {
  low.setValue(-BT_LARGE_FLOAT, -BT_LARGE_FLOAT, -BT_LARGE_FLOAT);
  high.setValue(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
}

void Broadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
  if (changed_) sort_bodies();
  read_positions();
  if (changed_ || list_is_stale()) rebuild(dispatcher);
}

void Broadphase::list_now(btDispatcher* dispatcher) {
  changed_ = true;
  calculateOverlappingPairs(dispatcher);
}

void Broadphase::sort_bodies() {
  const auto dead = std::partition(bodies_.begin(), bodies_.end(), [](auto* p) { return object(p) != nullptr; });
  removed_.insert(removed_.end(), dead, bodies_.end());
  bodies_.erase(dead, bodies_.end());
  std::sort(bodies_.begin(), bodies_.end(), [](auto* p, auto* q) { return key(p) < key(q); });
  elements_ = 0;
  largest_radius_ = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i]->m_uniqueId = static_cast<int>(i);
    if (tag(bodies_[i]).is_boundary()) continue;
    ++elements_;
    largest_radius_ = std::max(largest_radius_, tag(bodies_[i]).bounding_radius);
  }
}

void Broadphase::read_positions() {
  position_.resize(elements_);
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    const btCollisionObject& o = *object(bodies_[i]);
    const BodyTag& t = tag(bodies_[i]);
    if (!t.is_boundary()) {
      const btVector3& x = o.getWorldTransform().getOrigin();
      position_[i] = {x.x(), x.y(), x.z()};
      if (!t.spherical) update_box(*bodies_[i]);
    } else if (!o.getCollisionShape()->isConcave()) {
      update_box(*bodies_[i]);
    }
  }
}

/// True once some element or boundary has moved half the skin since the list was made.
bool Broadphase::list_is_stale() const {
  constexpr btScalar limit = skin * skin / 4;
  for (std::uint32_t i = 0; i < elements_; ++i) {
    btScalar moved = 0;
    for (int a = 0; a < 3; ++a) {
      const btScalar d = position_[i][a] - listed_position_[i][a];
      moved += d * d;
    }
    if (!(moved <= limit)) return true;
  }
  for (std::size_t b = elements_; b < bodies_.size(); ++b)
    if (!(boundary_motion(*object(bodies_[b]), listed_pose_[b - elements_]) <= skin / 2)) return true;
  return false;
}

void Broadphase::rebuild(btDispatcher* dispatcher) {
  touching_.clear();
  for (int i = 0; i < pairs_.size(); ++i)
    if (!alive(pairs_[i])) release(pairs_[i], dispatcher);
  each_contact_pair([&](const btBroadphasePair& pair) { touching_.push_back(pair); });
  candidates_.clear();
  list_element_pairs();
  carry_over_algorithms(dispatcher);
  listed_position_ = position_;
  listed_pose_.clear();
  for (std::size_t b = elements_; b < bodies_.size(); ++b)
    listed_pose_.push_back(object(bodies_[b])->getWorldTransform());
  for (btBroadphaseProxy* p : removed_) delete p;
  removed_.clear();
  changed_ = false;
}

void Broadphase::list_element_pairs() {
  grid_.build(position_, std::max(2 * largest_radius_ + skin, btScalar(1e-6)));
  for (std::uint32_t i = 0; i < elements_; ++i) list_pairs_of(i);
}

/// Appends the candidates of one element in ascending order of the other body.
void Broadphase::list_pairs_of(std::uint32_t i) {
  const btBroadphaseProxy& p = *bodies_[i];
  near_.clear();
  const btScalar reach = tag(&p).bounding_radius + skin;
  grid_.around(position_[i], [&](std::uint32_t j) {
    if (j <= i) return;
    btScalar d2 = 0;
    for (int a = 0; a < 3; ++a) {
      const btScalar d = position_[i][a] - position_[j][a];
      d2 += d * d;
    }
    const btScalar limit = reach + tag(bodies_[j]).bounding_radius;
    if (d2 <= limit * limit) near_.push_back(j);
  });
  std::sort(near_.begin(), near_.end());
  for (std::uint32_t b = elements_; b < bodies_.size(); ++b)
    if (may_touch_boundary(i, *object(bodies_[b]))) near_.push_back(b);
  for (std::uint32_t j : near_)
    if (needsBroadphaseCollision(bodies_[i], bodies_[j])) candidates_.push_back({i, j});
}

bool Broadphase::may_touch_boundary(std::uint32_t i, const btCollisionObject& boundary) const {
  const btVector3 centre(position_[i][0], position_[i][1], position_[i][2]);
  const btScalar reach = tag(bodies_[i]).bounding_radius + skin;
  if (is_plane(boundary)) return height(boundary, centre) <= reach;
  return is_mesh(boundary) ? near_mesh(boundary, centre, reach) : near_box(boundary, centre, reach);
}

/// Both lists ascend in (key, key), so one pass moves what is still listed and releases the rest.
void Broadphase::carry_over_algorithms(btDispatcher* dispatcher) {
  pairs_.resizeNoInitialize(static_cast<int>(candidates_.size()));
  const auto keys = [](const btBroadphasePair& p) { return std::pair(key(p.m_pProxy0), key(p.m_pProxy1)); };
  auto old = touching_.begin();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    btBroadphasePair& pair = pairs_[static_cast<int>(i)];
    pair.m_pProxy0 = bodies_[candidates_[i].a];
    pair.m_pProxy1 = bodies_[candidates_[i].b];
    pair.m_algorithm = nullptr;
    pair.m_internalInfo1 = nullptr;
    for (; old != touching_.end() && keys(*old) < keys(pair); ++old) release(*old, dispatcher);
    if (old != touching_.end() && keys(*old) == keys(pair)) pair.m_algorithm = (old++)->m_algorithm;
  }
  for (; old != touching_.end(); ++old) release(*old, dispatcher);
}

bool Broadphase::needsBroadphaseCollision(btBroadphaseProxy* p, btBroadphaseProxy* q) const {
  return (p->m_collisionFilterGroup & q->m_collisionFilterMask) &&
         (q->m_collisionFilterGroup & p->m_collisionFilterMask);
}

void Broadphase::release(btBroadphasePair& pair, btDispatcher* dispatcher) {
  if (!pair.m_algorithm) return;
  pair.m_algorithm->~btCollisionAlgorithm();
  dispatcher->freeCollisionAlgorithm(pair.m_algorithm);
  pair.m_algorithm = nullptr;
}

void Broadphase::release_all(btDispatcher* dispatcher) {
  for (int i = 0; i < pairs_.size(); ++i) release(pairs_[i], dispatcher);
}

bool Broadphase::touches(const Candidate& c, const btBroadphasePair& pair) const {
  const BodyTag& a = tag(pair.m_pProxy0);
  const BodyTag& b = tag(pair.m_pProxy1);
  if (b.is_boundary()) {
    const btCollisionObject& boundary = *object(pair.m_pProxy1);
    const btVector3 centre(position_[c.a][0], position_[c.a][1], position_[c.a][2]);
    if (is_plane(boundary)) return height(boundary, centre) <= a.bounding_radius + contact_reach;
    if (is_mesh(boundary)) return true;
    return near_box(boundary, centre, a.bounding_radius + contact_reach);
  }
  btScalar d2 = 0;
  for (int k = 0; k < 3; ++k) {
    const btScalar d = position_[c.a][k] - position_[c.b][k];
    d2 += d * d;
  }
  const btScalar reach = a.bounding_radius + b.bounding_radius;
  if (a.spherical && b.spherical) return d2 <= reach * reach;
  const btScalar wide = reach + contact_reach;
  return d2 <= wide * wide && (a.spherical || b.spherical || boxes_overlap(*pair.m_pProxy0, *pair.m_pProxy1));
}

void Broadphase::processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher) {
  btManifoldArray scratch;
  for (int i = 0; i < pairs_.size(); ++i) {
    btBroadphasePair& pair = pairs_[i];
    if (!pair.m_algorithm && !touches(candidates_[static_cast<std::size_t>(i)], pair)) continue;
    callback->processOverlap(pair);
    if (pair.m_algorithm && !has_contacts(pair, scratch)) release(pair, dispatcher);
  }
}

void Broadphase::collect_manifolds(btAlignedObjectArray<btPersistentManifold*>& out) {
  out.resize(0);
  each_contact_pair([&](btBroadphasePair& pair) { pair.m_algorithm->getAllContactManifolds(out); });
}

btBroadphasePair* Broadphase::find(std::uint64_t key_a, std::uint64_t key_b) {
  const auto wanted = std::pair(key_a, key_b);
  const auto less = [&](const Candidate& c, const auto& w) {
    return std::pair(key(bodies_[c.a]), key(bodies_[c.b])) < w;
  };
  const auto at = std::lower_bound(candidates_.begin(), candidates_.end(), wanted, less);
  if (at == candidates_.end() || std::pair(key(bodies_[at->a]), key(bodies_[at->b])) != wanted) return nullptr;
  return &pairs_[static_cast<int>(at - candidates_.begin())];
}

btBroadphasePair* Broadphase::findPair(btBroadphaseProxy* p, btBroadphaseProxy* q) {
  return find(std::min(key(p), key(q)), std::max(key(p), key(q)));
}

}  // namespace moraine::bullet
