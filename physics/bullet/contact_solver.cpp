// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/contact_solver.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "physics/bullet/broadphase.hpp"
#include "physics/bullet/impact_memory.hpp"

namespace moraine::bullet {
namespace {

constexpr btScalar off = -1e10F;                // a right-hand side that no approach can outweigh: the row never pushes
constexpr btScalar negligible_overlap = 1e-7F;  // [element diameters]; float32 resolves no less

/// A vector's three numbers and the padding after them, for the processor's four lanes.
using Lanes = Eigen::Array<btScalar, 4, 1>;
Eigen::Map<const Lanes> lanes(const btVector3& v) { return Eigen::Map<const Lanes>(v.m_floats); }
Eigen::Map<Lanes> lanes(btVector3& v) { return Eigen::Map<Lanes>(v.m_floats); }

/// Speed at which the row's gap opens when its bodies move like this.
btScalar opening(const btSolverConstraint& row, const btVector3& linear_a, const btVector3& angular_a,
                 const btVector3& linear_b, const btVector3& angular_b) {
  const Lanes sum = lanes(row.m_contactNormal1) * lanes(linear_a) + lanes(row.m_relpos1CrossNormal) * lanes(angular_a) +
                    lanes(row.m_contactNormal2) * lanes(linear_b) + lanes(row.m_relpos2CrossNormal) * lanes(angular_b);
  return sum[0] + sum[1] + sum[2];
}

/// The part of that speed which the solver has made.
btScalar change(const btSolverConstraint& row, const btSolverBody& a, const btSolverBody& b) {
  return opening(row, a.getDeltaLinearVelocity(), a.getDeltaAngularVelocity(), b.getDeltaLinearVelocity(),
                 b.getDeltaAngularVelocity());
}

void push(btSolverBody& body, const btVector3& normal, const btVector3& angular, btScalar impulse) {
  lanes(body.internalGetDeltaLinearVelocity()) += lanes(normal) * (body.internalGetInvMass().x() * impulse);
  lanes(body.internalGetDeltaAngularVelocity()) += lanes(angular) * impulse;
}

void apply(btSolverConstraint& row, btSolverBody& a, btSolverBody& b, btScalar impulse) {
  row.m_appliedImpulse += impulse;
  push(a, row.m_contactNormal1, row.m_angularComponentA, impulse);
  push(b, row.m_contactNormal2, row.m_angularComponentB, impulse);
}

bool carries(const btSolverBody& b) { return b.m_originalBody && tag(b.m_originalBody).carries; }

/// Two tangents share the smaller of their inverse masses: then a sliding contact's impulse is parallel to its slip.
void share_inverse_mass(btSolverConstraint& s, btSolverConstraint& t) {
  const btScalar shared = std::min(s.m_jacDiagABInv, t.m_jacDiagABInv);
  for (btSolverConstraint* row : {&s, &t}) {
    row->m_rhs *= shared / row->m_jacDiagABInv;
    row->m_jacDiagABInv = shared;
  }
}

}  // namespace

/// Each manifold's rows are prepared while they are still in the cache.
void ContactSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  const bool rough = info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS;
  split_rows_.clear();
  for (int i = 0; i < count; ++i) {
    int row = m_tmpSolverContactConstraintPool.size();
    convertContact(manifolds[i], info);
    for (; row < m_tmpSolverContactConstraintPool.size(); ++row) {
      btSolverConstraint& normal = m_tmpSolverContactConstraintPool[row];
      prepare_impact(normal, info);
      if (normal.m_rhsPenetration != 0) split_rows_.push_back(row);
      if (rough) prepare_friction(normal, info.m_warmstartingFactor);
    }
  }
}

/// Speed at which the bodies part before this step's forces.
btScalar ContactSolver::parting(const btSolverConstraint& row) const {
  const btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
  const btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  return opening(row, a.m_linearVelocity, a.m_angularVelocity, b.m_linearVelocity, b.m_angularVelocity);
}

bool ContactSolver::of_carriers(const btSolverConstraint& row) const {
  return carries(m_tmpSolverBodyPool[row.m_solverBodyIdA]) || carries(m_tmpSolverBodyPool[row.m_solverBodyIdB]);
}

void ContactSolver::prepare_impact(btSolverConstraint& row, const btContactSolverInfo& info) {
  btManifoldPoint& p = *static_cast<btManifoldPoint*>(row.m_originalContactPoint);
  const btScalar overlap = -p.getDistance(), parting_speed = parting(row);
  const bool impact = -parting_speed > info.m_restitutionVelocityThreshold && !of_carriers(row);
  if (impact && overlap < 0 && p.m_combinedRestitution > 0) row.m_rhs = off;
  const btScalar left = impact ? overlap : std::min(overlap, impact_overlap(p));
  if (left > negligible_overlap) {
    const btScalar rebound = impact ? -p.m_combinedRestitution * parting_speed : std::max(parting_speed, btScalar(0));
    take_back(row, info.m_erp2 * left / info.m_timeStep, rebound);
  }
  set_impact_overlap(p, left > negligible_overlap ? (1 - info.m_erp2) * left : btScalar(0));
}

/// Leaves to the split impulse what the rebound itself does not take back of an impact's overlap.
void ContactSolver::take_back(btSolverConstraint& row, btScalar speed, btScalar rebound) {
  if (row.m_rhsPenetration == 0) {  // Bullet itself splits deep overlaps
    row.m_rhsPenetration = speed * row.m_jacDiagABInv;
    row.m_rhs -= row.m_rhsPenetration;
  }
  row.m_rhsPenetration = std::max(row.m_rhsPenetration - rebound * row.m_jacDiagABInv, btScalar(0));
}

void ContactSolver::prepare_friction(const btSolverConstraint& normal, btScalar warm_start) {
  const btManifoldPoint& p = *static_cast<const btManifoldPoint*>(normal.m_originalContactPoint);
  btSolverConstraint* tangents = &m_tmpSolverContactFrictionConstraintPool[normal.m_frictionIndex];
  share_inverse_mass(tangents[0], tangents[1]);
  if (normal.m_rhs == off) return;
  btSolverBody& a = m_tmpSolverBodyPool[normal.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[normal.m_solverBodyIdB];
  apply(tangents[0], a, b, warm_start * p.m_appliedImpulseLateral1);
  apply(tangents[1], a, b, warm_start * p.m_appliedImpulseLateral2);
}

void ContactSolver::solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject**, int, btPersistentManifold**, int,
                                                                  btTypedConstraint**, int,
                                                                  const btContactSolverInfo& info, btIDebugDraw*) {
  for (int iteration = 0; iteration < info.m_numIterations; ++iteration)
    for (const int i : split_rows_) {
      const btSolverConstraint& row = m_tmpSolverContactConstraintPool[i];
      resolveSplitPenetrationSIMD(m_tmpSolverBodyPool[row.m_solverBodyIdA], m_tmpSolverBodyPool[row.m_solverBodyIdB],
                                  row);
    }
}

btScalar ContactSolver::solve_normal(btSolverConstraint& row) {
  btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  const btScalar wanted = row.m_rhs - change(row, a, b) * row.m_jacDiagABInv;
  const btScalar impulse = std::max(wanted, -row.m_appliedImpulse);
  apply(row, a, b, impulse);
  return impulse * impulse;
}

btScalar ContactSolver::solve_friction(const btSolverConstraint& normal) {
  btSolverConstraint& s = m_tmpSolverContactFrictionConstraintPool[normal.m_frictionIndex];
  btSolverConstraint& t = m_tmpSolverContactFrictionConstraintPool[normal.m_frictionIndex + 1];
  const btScalar limit = normal.m_friction * normal.m_appliedImpulse;
  if (limit == 0 && s.m_appliedImpulse == 0 && t.m_appliedImpulse == 0) return 0;
  btSolverBody& a = m_tmpSolverBodyPool[s.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[s.m_solverBodyIdB];
  btScalar p = s.m_appliedImpulse + s.m_rhs - change(s, a, b) * s.m_jacDiagABInv;
  btScalar q = t.m_appliedImpulse + t.m_rhs - change(t, a, b) * t.m_jacDiagABInv;
  const btScalar size2 = p * p + q * q;
  if (size2 > limit * limit) {
    const btScalar share = limit / btSqrt(size2);
    p *= share;
    q *= share;
  }
  p -= s.m_appliedImpulse;
  q -= t.m_appliedImpulse;
  apply(s, a, b, p);
  apply(t, a, b, q);
  return p * p + q * q;
}

btScalar ContactSolver::solveSingleIteration(int, btCollisionObject**, int, btPersistentManifold**, int,
                                             btTypedConstraint**, int, const btContactSolverInfo& info, btIDebugDraw*) {
  btConstraintArray& normals = m_tmpSolverContactConstraintPool;
  btScalar residual = 0;
  for (int i = 0; i < normals.size(); ++i) residual = std::max(residual, solve_normal(normals[i]));
  if (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS)
    for (int i = 0; i < normals.size(); ++i) residual = std::max(residual, solve_friction(normals[i]));
  return residual;
}

}  // namespace moraine::bullet
