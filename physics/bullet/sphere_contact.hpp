// SPDX-License-Identifier: Apache-2.0
// Contact between two spheres: one persistent point.
#pragma once

#include <btBulletDynamicsCommon.h>

namespace moraine::bullet {

/// Replaces Bullet's own sphere-sphere algorithm. That one lets the contact point drift with the surfaces and starts a
/// new one, without memory, whenever two spheres roll on each other; and it applies friction at two points an overlap
/// apart, which makes angular momentum. Here a pair has one point, half way between the surfaces, for as long as it
/// touches; its friction directions turn with the normal and its impulses are kept.
class SphereContact final : public btCollisionAlgorithm {
 public:
  SphereContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                const btCollisionObjectWrapper* b);
  ~SphereContact() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, const btDispatcherInfo&,
                        btManifoldResult*) override;
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& out) override { out.push_back(manifold_); }

  struct Maker final : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };

 private:
  btPersistentManifold* manifold_;
};

}  // namespace moraine::bullet
