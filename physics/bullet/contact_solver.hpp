// SPDX-License-Identifier: Apache-2.0
// Bullet's sequential-impulse solver with impacts that keep their restitution and a round friction cone.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

namespace moraine::bullet {

/// Bullet sets up the rows; impacts and friction are then done differently.
///
/// Impacts: a contact whose bodies approach faster than the restitution threshold. With restitution it acts only once
/// the surfaces have met: Bullet would brake the bodies to gap/h before. The overlap with which an impact is found is
/// an artefact of the step; it is taken back by moving the bodies (split impulse), the share overlap_recovery per step,
/// and not by Bullet's velocity erp * overlap / h, which would come on top of the rebound. All other overlap, that of
/// resting contacts, is left to that velocity.
///
/// Friction: the two tangential impulses of a contact are solved together and confined to the disc |p| <= mu N, so
/// friction opposes slip in every direction (projected Gauss-Seidel on the Coulomb cone, e.g. Bender et al. 2014,
/// Comput. Graph. Forum 33:246). Bullet confines each of them on its own.
///
/// Tangential impulses start from those of the last step, as normal ones do; Bullet 3.24 lets them start from none.
///
/// Contacts of bodies that carry (see Body) are left as Bullet has them, but for the cone: such bodies enter the step
/// with impulses that look like approach and already hold part of the friction.
///
/// Joints are not solved; there are none.
class ContactSolver : public btSequentialImpulseConstraintSolver {
 protected:
  void convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) override;
  void solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject** bodies, int body_count,
                                                     btPersistentManifold** manifolds, int manifold_count,
                                                     btTypedConstraint** constraints, int constraint_count,
                                                     const btContactSolverInfo& info, btIDebugDraw* draw) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** constraints,
                                int constraint_count, const btContactSolverInfo& info, btIDebugDraw* draw) override;

 private:
  btScalar parting(const btSolverConstraint& row) const;
  bool of_carriers(const btSolverConstraint& row) const;
  void prepare_impact(btSolverConstraint& row, const btContactSolverInfo& info);
  static void take_back(btSolverConstraint& row, btScalar speed, btScalar rebound);
  void prepare_friction(const btSolverConstraint& normal, btScalar warm_start);
  btScalar solve_normal(btSolverConstraint& row);
  btScalar solve_friction(const btSolverConstraint& normal);

  std::vector<int> split_rows_;  ///< of this step: those contact rows that have a split impulse
};

}  // namespace moraine::bullet
