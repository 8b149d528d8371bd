// SPDX-License-Identifier: Apache-2.0
// Bullet's dynamics world with the parts switched off that a granular sub-model does not need.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "physics/bullet/bond_solver.hpp"
#include "physics/bullet/broadphase.hpp"

namespace moraine::bullet {

/// No islands, no sleeping, no swept tests, no motion states; contacts reach the solver in id order.
class Dynamics final : public btDiscreteDynamicsWorld {
 public:
  Dynamics(btDispatcher* dispatcher, Broadphase* broadphase, Bonds* bonds, btCollisionConfiguration* config)
      : btDiscreteDynamicsWorld(dispatcher, broadphase, nullptr, config), pairs_(*broadphase), bonds_(*bonds) {}

  void updateAabbs() override {}  // the broad phase reads transforms itself
  int manifold_count() const { return manifolds_.size(); }

 protected:
  void calculateSimulationIslands() override {}
  void createPredictiveContacts(btScalar) override {}
  void saveKinematicState(btScalar) override {}  // driven bodies are given pose and velocity before each step
  void updateActivationState(btScalar) override {}
  void synchronizeMotionStates() override {}

  void solveConstraints(btContactSolverInfo& info) override {
    pairs_.collect_manifolds(manifolds_);
    btCollisionObjectArray& all = getCollisionObjectArray();
    if (all.size() == 0) return;
    btPersistentManifold** manifolds = manifolds_.size() ? &manifolds_[0] : nullptr;
    BondSolver::of_thread(bonds_).solveGroup(&all[0], all.size(), manifolds, manifolds_.size(), nullptr, 0, info,
                                             nullptr, getDispatcher());
  }

 private:
  Broadphase& pairs_;
  Bonds& bonds_;
  btAlignedObjectArray<btPersistentManifold*> manifolds_;
};

}  // namespace moraine::bullet
