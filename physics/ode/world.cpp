// SPDX-License-Identifier: Apache-2.0
#include "physics/ode/world.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "physics/errors.hpp"

namespace moraine::ode {
namespace {

constexpr double skin = 0.15;                           // of the lists [typical diameters]
constexpr double restitution_threshold = 0.2 / 3.1321;  // as engine bullet: slower impacts do not bounce

}  // namespace

Dynamics::Dynamics(const WorldSettings& settings, const Units& units)
    : world_(dWorldCreate()),
      joints_(dJointGroupCreate(0)),
      threading_(dThreadingAllocateSelfThreadedImplementation()) {
  const Vec3 g = settings.gravity * (units.time * units.time / units.length);
  dWorldSetGravity(world_, g.x(), g.y(), g.z());
  dWorldSetQuickStepNumIterations(world_, settings.iterations);
  dWorldSetCFM(world_, 0);  // hard contacts
  dWorldSetAutoDisableFlag(world_, 0);
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_), threading_);
}

void Dynamics::step(double h) {
  stepping_ = true;
  dWorldQuickStep(world_, h);
  dJointGroupEmpty(joints_);
  stepping_ = false;
}

/// ODE cannot tidy up what a step left that ended with an error.
Dynamics::~Dynamics() {
  if (stepping_) return;
  dJointGroupDestroy(joints_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

OdeWorld::OdeWorld(const WorldSettings& settings, const Vec3& origin)
    : settings_(settings),
      units_(settings, origin),
      h_(settings.substep / settings.time_unit),
      dynamics_(settings, units_),
      bodies_(dynamics_.world(), *settings.scene, units_),
      walls_(*settings.scene, units_),
      bonds_(*settings.scene) {}

Slot OdeWorld::add(const Body& body) {
  const std::size_t count = bodies_.roster.count() + walls_.walls().size() + 1;
  if (count > settings_.limits.elements)
    throw InputError(
        fmt::format("engine ode: {} elements, ghosts and boundaries in one "
                    "sub-model, the limit is {}; use more "
                    "sub-models",
                    count, settings_.limits.elements));
  return bodies_.add(body);
}

void OdeWorld::motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const {
  out.resize(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Place p = bodies_.place(slots[i]);
    out[i] = {bodies_.position(p), bodies_.twist(p)};
  }
}

void OdeWorld::step(double t) {
  settle();
  bonds_.break_long(bodies_);
  walls_.move(t);
  if (stale_ || moved_too_far()) list_anew();
  bodies_.upload();
  find_touches();
  bonds_.make_joints(bodies_, units_, h_, dynamics_.world(), dynamics_.joints());
  feedback_.assign(touches_.size(), {});
  for (std::size_t i = 0; i < touches_.size(); ++i) make_contact(touches_[i], feedback_[i]);
  dynamics_.step(h_);
  sum_boundary_impulse();
  bodies_.download();
}

void OdeWorld::settle() {
  if (!bodies_.roster.unsettled()) return;
  bodies_.settle();
  stale_ = true;
}

bool OdeWorld::moved_too_far() const {
  const double limit = 0.5 * skin * units_.length;
  bool far = walls_.walls().moved() >= limit;
  for (Place p = 0; p < bodies_.size(); ++p)
    far |= (bodies_.position(p) - listed_[p].centre).squaredNorm() >= limit * limit;
  return far;
}

void OdeWorld::list_anew() {
  listed_.clear();
  for (Place p = 0; p < bodies_.size(); ++p) listed_.push_back(bodies_.ball(p));
  grid_.build(listed_, skin * units_.length);
  pairs_.build(grid_, listed_, bodies_.ghost, skin * units_.length);
  walls_.list(grid_, listed_, bodies_.ghost, skin * units_.length);
  stale_ = false;
}

/// Ascending by pair, then those with boundaries; which candidates there are
/// beside those that touch does not matter.
void OdeWorld::find_touches() {
  touches_.clear();
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Place a = pairs_.lower()[k], b = pairs_.higher()[k];
    if (!bodies_.sound(a) || !bodies_.sound(b)) continue;
    for (const Geom& part : bodies_.parts(a))
      for (const Geom& other : bodies_.parts(b)) collide(part.get(), other.get(), {a, b, false, {}}, touches_);
  }
  walls_.find(bodies_, touches_);
}

dSurfaceParameters OdeWorld::surface(const Touch& touch) const {
  const std::uint32_t other =
      touch.with_boundary ? settings_.scene->boundaries[touch.b].material : bodies_.records[touch.b].material;
  const PairLaw& law = settings_.scene->materials.pair(bodies_.records[touch.a].material, other);
  dSurfaceParameters s{};
  s.mode = dContactApprox1 | dContactSoftERP | dContactFDir1;
  s.mu = law.friction;
  s.soft_erp = settings_.overlap_recovery;
  if (settings_.features.restitution && law.restitution > 0) {
    s.mode |= dContactBounce;
    s.bounce = law.restitution;
    s.bounce_vel = settings_.gravity.isZero() ? 0 : restitution_threshold;
  }
  return s;
}

/// Friction acts along two directions that follow from the normal alone, each
/// limited by the normal force: a pyramid.
void OdeWorld::make_contact(const Touch& touch, dJointFeedback& feedback) {
  dContact c{};
  c.surface = surface(touch);
  c.geom = touch.at;
  dVector3 across;
  dPlaneSpace(c.geom.normal, c.fdir1, across);
  if (touch.with_boundary && walls_.walls()[touch.b].moves()) {
    const Vec3 v = walls_.walls()[touch.b].velocity(units_.world(vec(c.geom.pos))) / units_.velocity();
    c.surface.mode |= dContactMotionN | dContactMotion1 | dContactMotion2;
    c.surface.motionN = v.dot(vec(c.geom.normal));
    c.surface.motion1 = v.dot(vec(c.fdir1));
    c.surface.motion2 = v.dot(vec(across));
  }
  const dJointID joint = dJointCreateContact(dynamics_.world(), dynamics_.joints(), &c);
  dJointAttach(joint, bodies_.body(touch.a), touch.with_boundary ? nullptr : bodies_.body(touch.b));
  dJointSetFeedback(joint, &feedback);
}

void OdeWorld::sum_boundary_impulse() {
  boundary_impulse_ = {};
  boundary_work_ = 0;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    if (!touches_[i].with_boundary) continue;
    const Vec3 given = units_.momentum() * h_ * vec(feedback_[i].f1);
    const Vec3 point = units_.world(vec(touches_[i].at.pos));
    boundary_impulse_ += {given, point.cross(given)};
    boundary_work_ += given.dot(walls_.walls()[touches_[i].b].velocity(point));
  }
}

Contact OdeWorld::contact(std::size_t i) const {
  const Touch& t = touches_[i];
  return {bodies_.roster.id(t.a),
          t.with_boundary ? t.b : bodies_.roster.id(t.b),
          t.with_boundary,
          units_.world(vec(t.at.pos)),
          vec(t.at.normal),
          units_.length * t.at.depth,
          units_.momentum() * h_ * vec(feedback_[i].f1)};
}

std::vector<Contact> OdeWorld::contacts() const {
  std::vector<Contact> out;
  if (bodies_.roster.unsettled()) return out;
  for (std::size_t i = 0; i < touches_.size(); ++i) out.push_back(contact(i));
  std::stable_sort(out.begin(), out.end(), earlier);
  return out;
}

}  // namespace moraine::ode
