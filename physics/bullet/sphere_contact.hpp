// SPDX-License-Identifier: Apache-2.0
// Contact between two spheres: one persistent point.
#pragma once

#include <btBulletDynamicsCommon.h>

namespace moraine::bullet {

/// Replaces Bullet's own sphere-sphere algorithm. That one lets the contact point drift with the surfaces and starts a
/// new one, without memory, whenever two spheres roll on each other; and it applies friction at two points an overlap
/// apart, which makes angular momentum. Here a pair has one point, half way between the surfaces, for as long as it
/// touches; its friction directions turn with the normal and its impulses are kept.
///
/// A contact that sticks remembers where: what the surfaces slip all the same is taken back like an overlap, the share
/// slip_recovery per step, by the tangential velocity that friction aims at (Bullet's contact motion). Friction that
/// acts on velocities alone creeps, as a solver never converges fully and copies of an element differ a little. It is
/// the tangential displacement of Cundall & Strack (1979, Geotechnique 29:47) with the solver in place of the spring; a
/// contact that slides begins anew.
class SphereContact final : public btCollisionAlgorithm {
 public:
  SphereContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                const btCollisionObjectWrapper* b, btScalar slip_recovery);
  ~SphereContact() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, const btDispatcherInfo&,
                        btManifoldResult*) override;
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& out) override { out.push_back(manifold_); }

  struct Maker final : btCollisionAlgorithmCreateFunc {
    explicit Maker(btScalar recovery) : slip_recovery(recovery) {}
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
    btScalar slip_recovery;
  };

 private:
  btScalar slip_recovery_;
  btPersistentManifold* manifold_;
};

}  // namespace moraine::bullet
