// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/bond_solver.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::bullet {
namespace {

constexpr btScalar explicit_limit = 0.5F;  // h sqrt(k/m*) up to which bonds are integrated without numerical damping

auto place(std::vector<BondSpring>& springs, std::uint32_t bond) {
  return std::lower_bound(springs.begin(), springs.end(), bond,
                          [](const BondSpring& s, std::uint32_t b) { return s.bond < b; });
}

btVector3 line(const BondSpring& s) {
  return s.a->getWorldTransform().getOrigin() - s.b->getWorldTransform().getOrigin();
}

/// Velocity at the end of the step as the solver knows it so far.
btVector3 velocity(const btSolverBody& b) {
  return b.m_linearVelocity + b.m_externalForceImpulse + b.m_deltaLinearVelocity;
}

}  // namespace

void Bonds::add(const BondSpring& spring) { springs_.insert(place(springs_, spring.bond), spring); }

void Bonds::remove(std::uint32_t bond) {
  const auto at = place(springs_, bond);
  if (at != springs_.end() && at->bond == bond) springs_.erase(at);
}

BondSolver& BondSolver::of_thread(Bonds& bonds) {
  thread_local BondSolver solver;
  solver.bonds_ = &bonds;
  return solver;
}

void BondSolver::convertJoints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) {
  ContactSolver::convertJoints(constraints, count, info);
  bonds_->drop_broken();
  rows_.clear();
  for (const BondSpring& s : bonds_->springs()) {
    rows_.push_back(make_row(s, info.m_timeStep));
    apply(rows_.back(), rows_.back().impulse);
  }
}

void Bonds::drop_broken() {
  broken_.clear();
  for (const BondSpring& s : springs_)
    if (!(line(s).length2() <= s.break_length * s.break_length)) broken_.push_back(s.bond);
  if (broken_.empty()) return;
  std::erase_if(springs_,
                [&](const BondSpring& s) { return std::binary_search(broken_.begin(), broken_.end(), s.bond); });
}

BondSolver::Row BondSolver::make_row(const BondSpring& s, btScalar h) {
  Row row;
  const btVector3 d = line(s);
  const btScalar length = d.length();
  row.axis = length > 0 ? d / length : btVector3(0, 0, 1);
  row.a = getOrInitSolverBody(*s.a, h);
  row.b = getOrInitSolverBody(*s.b, h);
  row.inverse_mass = s.a->getInvMass() + s.b->getInvMass();
  const bool stiff = h * std::sqrt(s.stiffness * row.inverse_mass) > explicit_limit;
  row.pull = h * s.stiffness * (length - s.rest_length);
  row.drag = h * ((stiff ? h * s.stiffness : btScalar(0)) + s.damping);
  row.impulse = s.impulse;
  return row;
}

void BondSolver::apply(const Row& row, btScalar impulse) {
  btSolverBody& a = m_tmpSolverBodyPool[row.a];
  btSolverBody& b = m_tmpSolverBodyPool[row.b];
  a.internalApplyImpulse(row.axis * a.internalGetInvMass(), btVector3(0, 0, 0), -impulse);
  b.internalApplyImpulse(row.axis * b.internalGetInvMass(), btVector3(0, 0, 0), impulse);
}

btScalar BondSolver::solve(Row& row) {
  const btVector3 relative = velocity(m_tmpSolverBodyPool[row.a]) - velocity(m_tmpSolverBodyPool[row.b]);
  const btScalar wanted = row.pull + row.drag * row.axis.dot(relative);
  const btScalar change = (wanted - row.impulse) / (1 + row.drag * row.inverse_mass);
  row.impulse += change;
  apply(row, change);
  return change;
}

btScalar BondSolver::solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                          btPersistentManifold** manifolds, int manifold_count,
                                          btTypedConstraint** constraints, int constraint_count,
                                          const btContactSolverInfo& info, btIDebugDraw* draw) {
  btScalar residual = 0;
  for (Row& row : rows_) {
    const btScalar change = solve(row);
    residual = std::max(residual, change * change);
  }
  return std::max(residual,
                  ContactSolver::solveSingleIteration(iteration, bodies, body_count, manifolds, manifold_count,
                                                      constraints, constraint_count, info, draw));
}

btScalar BondSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                                   const btContactSolverInfo& info) {
  for (std::size_t i = 0; i < rows_.size(); ++i) bonds_->springs()[i].impulse = rows_[i].impulse;
  return ContactSolver::solveGroupCacheFriendlyFinish(bodies, count, info);
}

}  // namespace moraine::bullet
