// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/contact_solver.hpp"

#include <algorithm>

#include "physics/bullet/broadphase.hpp"
#include "physics/bullet/impact_memory.hpp"

namespace moraine::bullet {
namespace {

constexpr btScalar off = -1e10F;              // a right-hand side that no approach can outweigh: the row never pushes
constexpr btScalar negligible_overlap = 1e-6F;  // [element diameters]; float32 does not resolve less

/// Rate at which the row's gap opens with the solver's changes of velocity.
btScalar change(const btSolverConstraint& row, const btSolverBody& a, const btSolverBody& b) {
  return row.m_contactNormal1.dot(a.getDeltaLinearVelocity()) + row.m_relpos1CrossNormal.dot(a.getDeltaAngularVelocity()) +
         row.m_contactNormal2.dot(b.getDeltaLinearVelocity()) + row.m_relpos2CrossNormal.dot(b.getDeltaAngularVelocity());
}

void apply(btSolverConstraint& row, btSolverBody& a, btSolverBody& b, btScalar impulse) {
  row.m_appliedImpulse += impulse;
  a.internalGetDeltaLinearVelocity() += row.m_contactNormal1 * (a.internalGetInvMass().x() * impulse);
  a.internalGetDeltaAngularVelocity() += row.m_angularComponentA * impulse;
  b.internalGetDeltaLinearVelocity() += row.m_contactNormal2 * (b.internalGetInvMass().x() * impulse);
  b.internalGetDeltaAngularVelocity() += row.m_angularComponentB * impulse;
}

bool is_shared(const btSolverBody& b) { return b.m_originalBody && tag(b.m_originalBody).shared; }

/// Two tangents share the smaller of their inverse masses: then a sliding contact's impulse is parallel to its slip.
void share_inverse_mass(btSolverConstraint& s, btSolverConstraint& t) {
  const btScalar shared = std::min(s.m_jacDiagABInv, t.m_jacDiagABInv);
  for (btSolverConstraint* row : {&s, &t}) {
    row->m_rhs *= shared / row->m_jacDiagABInv;
    row->m_jacDiagABInv = shared;
  }
}

}  // namespace

void ContactSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
  overlaps_to_split_ = false;
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i)
    prepare_impact(m_tmpSolverContactConstraintPool[i], info);
  btConstraintArray& tangents = m_tmpSolverContactFrictionConstraintPool;
  if (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS)
    for (int i = 0; i < tangents.size(); i += 2) share_inverse_mass(tangents[i], tangents[i + 1]);
}

/// Speed at which the bodies approached before this step's forces.
btScalar ContactSolver::approach(const btSolverConstraint& row) const {
  const btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
  const btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  return -row.m_contactNormal1.dot(a.m_linearVelocity) - row.m_relpos1CrossNormal.dot(a.m_angularVelocity) -
         row.m_contactNormal2.dot(b.m_linearVelocity) - row.m_relpos2CrossNormal.dot(b.m_angularVelocity);
}

bool ContactSolver::of_shared(const btSolverConstraint& row) const {
  return is_shared(m_tmpSolverBodyPool[row.m_solverBodyIdA]) || is_shared(m_tmpSolverBodyPool[row.m_solverBodyIdB]);
}

void ContactSolver::prepare_impact(btSolverConstraint& row, const btContactSolverInfo& info) {
  btManifoldPoint& p = *static_cast<btManifoldPoint*>(row.m_originalContactPoint);
  const btScalar overlap = -p.getDistance();
  const bool impact = !of_shared(row) && approach(row) > info.m_restitutionVelocityThreshold;
  if (impact && overlap < 0 && p.m_combinedRestitution > 0) row.m_rhs = off;
  const btScalar quiet = impact ? overlap : std::min(overlap, impact_overlap(p));
  if (quiet > negligible_overlap && row.m_rhsPenetration == 0) {
    row.m_rhsPenetration = info.m_erp2 * quiet / info.m_timeStep * row.m_jacDiagABInv;
    row.m_rhs -= row.m_rhsPenetration;
  }
  set_impact_overlap(p, quiet > negligible_overlap ? (1 - info.m_erp2) * quiet : btScalar(0));
  overlaps_to_split_ |= row.m_rhsPenetration != 0;
}

void ContactSolver::solveGroupCacheFriendlySplitImpulseIterations(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds, int manifold_count,
    btTypedConstraint** constraints, int constraint_count, const btContactSolverInfo& info, btIDebugDraw* draw) {
  if (!overlaps_to_split_) return;
  btSequentialImpulseConstraintSolver::solveGroupCacheFriendlySplitImpulseIterations(
      bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, draw);
}

btScalar ContactSolver::solve_normal(btSolverConstraint& row) {
  btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  const btScalar wanted = row.m_rhs - change(row, a, b) * row.m_jacDiagABInv;
  const btScalar impulse = std::max(wanted, -row.m_appliedImpulse);
  apply(row, a, b, impulse);
  return impulse * impulse;
}

btScalar ContactSolver::solve_friction(const btSolverConstraint& normal, btSolverConstraint* tangents) {
  btSolverConstraint &s = tangents[0], &t = tangents[1];
  btSolverBody& a = m_tmpSolverBodyPool[s.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[s.m_solverBodyIdB];
  btScalar p = s.m_appliedImpulse + s.m_rhs - change(s, a, b) * s.m_jacDiagABInv;
  btScalar q = t.m_appliedImpulse + t.m_rhs - change(t, a, b) * t.m_jacDiagABInv;
  const btScalar limit = normal.m_friction * normal.m_appliedImpulse, size2 = p * p + q * q;
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
  btConstraintArray& tangents = m_tmpSolverContactFrictionConstraintPool;
  btScalar residual = 0;
  for (int i = 0; i < normals.size(); ++i) residual = std::max(residual, solve_normal(normals[i]));
  if (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS)
    for (int i = 0; i < normals.size(); ++i)
      residual = std::max(residual, solve_friction(normals[i], &tangents[normals[i].m_frictionIndex]));
  return residual;
}

}  // namespace moraine::bullet
