// SPDX-License-Identifier: Apache-2.0
// Which bodies may touch: a cell grid with a skin, and pairs that hold a manifold only while bodies do touch.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "physics/cell_grid.hpp"

namespace moraine::bullet {

/// What the broad phase needs to know of a body; elements come before boundaries in every order.
struct BodyTag {
  static constexpr std::uint64_t boundary_bit = std::uint64_t{1} << 32;
  std::uint64_t key = 0;  ///< element id, or boundary_bit | boundary index: the canonical order
  std::uint32_t material = 0;
  btScalar bounding_radius = 0;  ///< scaled; unused for boundaries
  bool spherical = false;
  bool carries = false;  ///< see Body
  bool is_boundary() const { return key & boundary_bit; }
};

/// Who meets whom: ghosts meet real elements only, boundaries too.
enum Group : int { real_group = 1, ghost_group = 2, boundary_group = 4 };

/// What the world has hung on a body.
inline const BodyTag& tag(const btCollisionObject* o) { return *static_cast<const BodyTag*>(o->getUserPointer()); }
inline const BodyTag& tag(const btBroadphaseProxy* p) {
  return tag(static_cast<const btCollisionObject*>(p->m_clientObject));
}

/// A broad phase and pair cache in one. Candidate pairs (gap below a skin) are listed in ascending (key, key) order and
/// kept until some body has moved half the skin. Each step only candidates that really touch reach the narrow phase, so
/// what is computed depends on the bodies' present state and contacts, not on the list's age.
class Broadphase final : public btBroadphaseInterface, private btOverlappingPairCache {
 public:
  Broadphase();
  ~Broadphase() override;

  /// Called for each touching pair's manifolds, in pair order, after the narrow phase.
  void collect_manifolds(btAlignedObjectArray<btPersistentManifold*>& out);
  /// Drops the contacts of pairs for which `which(body0, body1)` holds: their next step starts without memory.
  template <class Which>
  void forget_contacts(btDispatcher* dispatcher, Which which) {
    for (int i = 0; i < pairs_.size(); ++i)
      if (alive(pairs_[i]) && which(object(pairs_[i].m_pProxy0), object(pairs_[i].m_pProxy1)))
        release(pairs_[i], dispatcher);
  }
  /// Drops all contacts.
  void release_all(btDispatcher* dispatcher);
  /// Visits every pair that holds contacts, in pair order: visit(pair).
  template <class Visit>
  void each_contact_pair(Visit visit) {
    for (int i = 0; i < pairs_.size(); ++i)
      if (pairs_[i].m_algorithm && alive(pairs_[i])) visit(pairs_[i]);
  }
  /// Lists the candidates afresh, so that pairs exist for contacts about to be restored.
  void list_now(btDispatcher* dispatcher);
  /// The candidate pair of two keys, or null.
  btBroadphasePair* find(std::uint64_t key_a, std::uint64_t key_b);

  /// Null once the body has left the world.
  static btCollisionObject* object(const btBroadphaseProxy* proxy) {
    return static_cast<btCollisionObject*>(proxy->m_clientObject);
  }

  // Broad phase
  btBroadphaseProxy* createProxy(const btVector3& low, const btVector3& high, int shape_type, void* user, int group,
                                 int mask, btDispatcher* dispatcher) override;
  void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;
  void setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high, btDispatcher*) override;
  void getAabb(btBroadphaseProxy* proxy, btVector3& low, btVector3& high) const override;
  void rayTest(const btVector3&, const btVector3&, btBroadphaseRayCallback&, const btVector3&,
               const btVector3&) override;
  void aabbTest(const btVector3& low, const btVector3& high, btBroadphaseAabbCallback& callback) override;
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;
  btOverlappingPairCache* getOverlappingPairCache() override { return this; }
  const btOverlappingPairCache* getOverlappingPairCache() const override { return this; }
  void getBroadphaseAabb(btVector3& low, btVector3& high) const override;
  void printStats() override {}

 private:
  struct Candidate {
    std::uint32_t a, b;  ///< places in bodies_; a < b
  };

  static bool alive(const btBroadphasePair& pair) { return object(pair.m_pProxy0) && object(pair.m_pProxy1); }
  void sort_bodies();
  void read_positions();
  bool list_is_stale() const;
  void rebuild(btDispatcher* dispatcher);
  void list_element_pairs();
  void list_pairs_of(std::uint32_t element);
  void list_boundary_pairs(std::uint32_t boundary);
  bool may_touch_boundary(std::uint32_t element, const btCollisionObject& boundary) const;
  void carry_over_algorithms(btDispatcher* dispatcher);
  bool touches(const Candidate& c, const btBroadphasePair& pair) const;
  void release(btBroadphasePair& pair, btDispatcher* dispatcher);

  // Pair cache
  btBroadphasePair* getOverlappingPairArrayPtr() override { return pairs_.size() ? &pairs_[0] : nullptr; }
  const btBroadphasePair* getOverlappingPairArrayPtr() const override { return pairs_.size() ? &pairs_[0] : nullptr; }
  btBroadphasePairArray& getOverlappingPairArray() override { return pairs_; }
  void cleanOverlappingPair(btBroadphasePair& pair, btDispatcher* dispatcher) override { release(pair, dispatcher); }
  int getNumOverlappingPairs() const override { return pairs_.size(); }
  bool needsBroadphaseCollision(btBroadphaseProxy* p, btBroadphaseProxy* q) const override;
  btOverlapFilterCallback* getOverlapFilterCallback() override { return nullptr; }
  void cleanProxyFromPairs(btBroadphaseProxy*, btDispatcher*) override {}  // done for all at the next listing
  void setOverlapFilterCallback(btOverlapFilterCallback*) override {}
  void processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher) override;
  btBroadphasePair* findPair(btBroadphaseProxy*, btBroadphaseProxy*) override;
  bool hasDeferredRemoval() override { return false; }
  void setInternalGhostPairCallback(btOverlappingPairCallback*) override {}
  void sortOverlappingPairs(btDispatcher*) override {}
  btBroadphasePair* addOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*) override { return nullptr; }
  void* removeOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*, btDispatcher*) override { return nullptr; }
  void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}

  std::vector<btBroadphaseProxy*> bodies_;   ///< ascending key
  std::vector<btBroadphaseProxy*> removed_;  ///< freed at the next rebuild
  std::uint32_t elements_ = 0;               ///< bodies_ before the first boundary
  bool changed_ = true;
  std::vector<std::array<btScalar, 3>> position_, listed_position_;
  std::vector<btTransform> listed_pose_;  ///< of the boundaries
  btScalar largest_radius_ = 0;
  CellGrid<btScalar> grid_;
  std::vector<std::uint32_t> near_;
  std::vector<Candidate> candidates_;
  btBroadphasePairArray pairs_;             ///< one per candidate
  std::vector<btBroadphasePair> touching_;  ///< those with contacts, while the list is made afresh
};

}  // namespace moraine::bullet
