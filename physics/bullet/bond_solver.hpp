// SPDX-License-Identifier: Apache-2.0
// The contact solver with bonds added as one-row soft constraints.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/bullet/contact_solver.hpp"

namespace moraine::bullet {

/// A bond in Bullet's scaled units.
struct BondSpring {
  std::uint32_t bond = 0;  ///< scene index; the solving order
  btRigidBody* a = nullptr;
  btRigidBody* b = nullptr;
  btScalar rest_length = 0;
  btScalar stiffness = 0;
  btScalar damping = 0;
  btScalar break_length = 0;
  btScalar impulse = 0;  ///< of the last step, tension positive; the next step's first guess
};

/// The bonds of a world.
class Bonds {
 public:
  void add(const BondSpring& spring);
  void remove(std::uint32_t bond);
  void clear() { springs_.clear(); }
  std::span<const BondSpring> springs() const { return springs_; }
  std::span<BondSpring> springs() { return springs_; }
  /// Drops those that are longer than they may be.
  void drop_broken();
  std::span<const std::uint32_t> broken() const { return broken_; }

 private:
  std::vector<BondSpring> springs_;  ///< ascending bond
  std::vector<std::uint32_t> broken_;
};

/// Each bond is one row along the line of centres. Its impulse over a step h is
///   J = h k (L - L0) + Q v',  Q = h (theta h k + c),
/// with v' the stretching speed at the end of the step: theta = 0 (symplectic Euler, no numerical damping) while
/// h sqrt(k/m*) <= 1/2, which is stable in a packed lattice, and theta = 1 (implicit Euler) above. Bonds longer than
/// their break length are dropped before the step they would act in.
///
/// A solver keeps nothing from one solve to the next but the memory of its rows, three for every contact. So the worlds
/// that are stepped on one thread share one.
class BondSolver final : public ContactSolver {
 public:
  /// The solver of this thread, for a world with these bonds.
  static BondSolver& of_thread(Bonds& bonds);

 protected:
  void convertJoints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** constraints,
                                int constraint_count, const btContactSolverInfo& info, btIDebugDraw* draw) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                         const btContactSolverInfo& info) override;

 private:
  struct Row {
    btVector3 axis;         ///< from b to a
    int a, b;               ///< solver bodies
    btScalar inverse_mass;  ///< sum of both
    btScalar pull;          ///< h k (L - L0)
    btScalar drag;          ///< Q
    btScalar impulse;
  };
  Row make_row(const BondSpring& spring, btScalar h);
  void apply(const Row& row, btScalar impulse);
  btScalar solve(Row& row);

  Bonds* bonds_ = nullptr;
  std::vector<Row> rows_;  ///< one per spring, during a step
};

}  // namespace moraine::bullet
