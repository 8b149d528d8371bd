// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/settings.hpp"

#include <btBulletDynamicsCommon.h>

#include "physics/bullet/units.hpp"

namespace moraine::bullet {
namespace {

// Lengths inside a world are in element diameters and times in sqrt(d/g), so these hold at every scale. Bullet's own
// defaults are meant for bodies of about a metre under Earth's gravity; those are divided by sqrt(9.81 m/s^2 * 1 m).
constexpr btScalar restitution_threshold = 0.2F / 3.1321F;  // slower impacts do not bounce
constexpr btScalar split_impulse_threshold = -0.04F;        // deeper overlaps are removed without adding velocity
constexpr btScalar warm_start = 0.85F;                      // 1.0 lets even an uncut column gain energy

int solver_mode(const Features& features) {
  // Start from the last step's impulses: small steps with few iterations rely on it.
  int mode = SOLVER_SIMD | SOLVER_USE_WARMSTARTING;
  // Bullet's default friction acts along one direction that follows the velocity: 10 % too much run-out in a collapsing
  // column. With two directions, cached with the contact, the solver keeps friction to a round cone.
  if (features.friction)
    mode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING |
            SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
  // SOLVER_RANDMIZE_ORDER stays off: contacts are solved in id order, so the solver's seed is never drawn from.
  return mode;
}

}  // namespace

std::unique_ptr<btDefaultCollisionConfiguration> make_configuration() {
  btDefaultCollisionConstructionInfo info;
  // Small first pools; Bullet allocates beyond them as needed. The default of 4096 manifolds costs 4 MB per world.
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 64;
  return std::make_unique<btDefaultCollisionConfiguration>(info);
}

void apply_world_settings(btDiscreteDynamicsWorld& world, const WorldSettings& settings) {
  btContactSolverInfo& solver = world.getSolverInfo();
  solver.m_solverMode = solver_mode(settings.features);
  solver.m_numIterations = settings.iterations;
  solver.m_warmstartingFactor = warm_start;
  // Without gravity nothing has to come to rest on anything, and there is no speed to compare with.
  solver.m_restitutionVelocityThreshold = settings.gravity.isZero() ? 0 : restitution_threshold;
  solver.m_splitImpulse = 1;
  solver.m_splitImpulsePenetrationThreshold = split_impulse_threshold;
  // Bullet's 0.2 keeps tall stacks hopping; 0.1 lets them rest at twice the overlap.
  solver.m_erp = solver.m_erp2 = static_cast<btScalar>(settings.overlap_recovery);
  solver.m_sor = 1;                            // plain Gauss-Seidel
  solver.m_globalCfm = 0;                      // hard contacts
  solver.m_linearSlop = 0;                     // no tolerated overlap
  solver.m_damping = 1;                        // of Bullet's own joints; none are used
  solver.m_leastSquaresResidualThreshold = 0;  // never stop early: the cost and the result stay those asked for
  solver.m_minimumSolverBatchSize = 1 << 30;   // one batch: islands are not formed

  btDispatcherInfo& dispatch = world.getDispatchInfo();
  dispatch.m_useContinuous = false;                  // no swept tests; speed limits are guarded outside
  dispatch.m_deterministicOverlappingPairs = false;  // the broad phase already yields pairs in id order
  world.setForceUpdateAllAabbs(false);               // the broad phase reads positions itself
  const double g = settings.time_unit * settings.time_unit / settings.length_unit;
  world.setGravity(Units::raw(Vec3(settings.gravity * g)));
}

void apply_body_settings(btRigidBody& body, bool spherical) {
  body.setDamping(0, 0);                          // no drag
  body.setActivationState(DISABLE_DEACTIVATION);  // never sleep: sleeping depends on history and on islands
  body.setSleepingThresholds(0, 0);
  body.setRollingFriction(0);
  body.setSpinningFriction(0);
  body.setContactProcessingThreshold(BT_LARGE_FLOAT);
  body.setCcdMotionThreshold(0);
  // The gyroscopic term of bodies that are not spheres, implicit in the body frame: stable and without drift.
  body.setFlags(spherical ? 0 : BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY);
}

}  // namespace moraine::bullet
