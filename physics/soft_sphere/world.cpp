// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/world.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "physics/errors.hpp"

namespace moraine::soft_sphere {
namespace {

constexpr double list_skin = 0.15;  ///< in typical diameters

/// Turns q by the rotation vector `turn`, world frame, and keeps its length. The series is exact to 1e-15 where it is
/// used: turns below 0.02.
void rotate(Quat& q, const Vec3& turn) {
  const double a = 0.25 * turn.squaredNorm();
  if (a > 1e-4) {
    q = (Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * q).normalized();
    return;
  }
  const Vec3 s = 0.5 * (1 - a / 6 * (1 - a / 20)) * turn;
  const double c = 1 - a / 2 * (1 - a / 12);
  const Quat turned = Quat(c, s.x(), s.y(), s.z()) * q;
  q.coeffs() = turned.coeffs() * (1.5 - 0.5 * turned.squaredNorm());
}

}  // namespace

SoftSphereWorld::SoftSphereWorld(const WorldSettings& settings)
    : settings_(settings),
      laws_(*settings.scene),
      skin_(list_skin * settings.length_unit),
      pairs_(laws_),
      walls_(laws_, *settings.scene),
      bonds_(*settings.scene) {}

Slot SoftSphereWorld::add(const Body& body) {
  const std::size_t count = bodies_.count() + walls_.walls().size() + 1;
  if (count > settings_.limits.elements)
    throw InputError(
        fmt::format("engine soft_sphere: {} elements, ghosts and boundaries in one sub-model, the limit is {}; use "
                    "more sub-models",
                    count, settings_.limits.elements));
  return bodies_.add(body, settings_.scene->shapes[body.shape]);
}

void SoftSphereWorld::motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const {
  out.resize(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Place p = bodies_.place(slots[i]);
    out[i] = {bodies_.position[p], {bodies_.moving[p].velocity, bodies_.moving[p].spin}};
  }
}

void SoftSphereWorld::apply_impulse(Slot slot, const Impulse& impulse) {
  const Place p = bodies_.place(slot);
  Moving& m = bodies_.moving[p];
  m.velocity += impulse.linear * m.inverse_mass;
  m.spin += impulse.angular * bodies_.inverse_inertia(p);
}

/// Either end may be given first; the scene's order decides which body is the first of the pair.
void SoftSphereWorld::add_bond(std::uint32_t bond, Slot a, Slot b) {
  if (bodies_.entries[bodies_.place(a)].id != settings_.scene->bonds[bond].a) std::swap(a, b);
  bonds_.add(bond, a, b);
}

void SoftSphereWorld::step(double t) {
  settle();
  bonds_.break_long(bodies_);
  walls_.walls().move(t + settings_.substep / 2);
  drift_half();
  if (!listed_ || moved_too_far()) list_anew();
  pairs_.act(bodies_, settings_.substep);
  bonds_.act(bodies_);
  walls_.act(bodies_, settings_.substep);
  kick_and_drift();
}

/// Contacts follow their bodies to new places; those of bodies that left end.
void SoftSphereWorld::settle() {
  if (!bodies_.unsettled()) return;
  if (listed_) pairs_.lasting(lasting_);
  listed_ = false;
  const std::vector<Place>& now = bodies_.settle();
  for (LastingPair& c : lasting_) c = {now[c.low], now[c.high], c.springs};
  std::erase_if(lasting_, [](const LastingPair& c) { return c.low == nowhere || c.high == nowhere; });
  std::vector<LastingWallContact>& at_walls = walls_.lasting();
  for (LastingWallContact& c : at_walls) c.ball = now[c.ball];
  std::erase_if(at_walls, [](const LastingWallContact& c) { return c.ball == nowhere; });
}

void SoftSphereWorld::drift_half() {
  const double half = settings_.substep / 2;
  for (Place p = 0; p < bodies_.size(); ++p) {
    bodies_.ball[p].centre = bodies_.position[p] + half * bodies_.moving[p].velocity;
    bodies_.load[p] = {};
  }
}

bool SoftSphereWorld::moved_too_far() const {
  const double limit = skin_ / 2;
  bool far = walls_.walls().moved() >= limit;
  for (Place p = 0; p < bodies_.size(); ++p)
    far |= (bodies_.ball[p].centre - listed_at_[p]).squaredNorm() >= limit * limit;
  return far;
}

void SoftSphereWorld::list_anew() {
  if (listed_) pairs_.lasting(lasting_);
  recall();
  grid_.build(bodies_.ball, skin_);
  pairs_.list(grid_, bodies_, skin_, lasting_);
  walls_.list(grid_, bodies_, skin_);
  listed_at_.resize(bodies_.size());
  for (Place p = 0; p < bodies_.size(); ++p) listed_at_[p] = bodies_.ball[p].centre;
  listed_ = true;
  lasting_.clear();
}

/// Takes up contacts that began in other worlds, if both bodies are here.
void SoftSphereWorld::recall() {
  std::vector<LastingWallContact>& at_walls = walls_.lasting();
  for (const ContactMemory& m : memory_) {
    const Place a = bodies_.find(m.a), b = m.with_boundary ? m.b : bodies_.find(m.b);
    if (a == nowhere || b == nowhere) continue;
    const Springs springs{m.sliding, m.rolling};
    if (m.with_boundary)
      at_walls.push_back({a, b, m.normal, Vec3::Zero(), 0, springs});
    else
      lasting_.push_back({a, b, springs});
  }
  memory_.clear();
  std::stable_sort(lasting_.begin(), lasting_.end(),
                   [](auto& a, auto& b) { return std::pair(a.low, a.high) < std::pair(b.low, b.high); });
  std::stable_sort(at_walls.begin(), at_walls.end(),
                   [](auto& a, auto& b) { return std::pair(a.ball, a.wall) < std::pair(b.ball, b.wall); });
}

void SoftSphereWorld::kick_and_drift() {
  const double h = settings_.substep;
  const Vec3 fall = h * settings_.gravity;
  for (Place p = 0; p < bodies_.size(); ++p) {
    Moving& m = bodies_.moving[p];
    const Load& load = bodies_.load[p];
    m.velocity += fall + (h * m.inverse_mass) * load.force;
    bodies_.position[p] = bodies_.ball[p].centre + (h / 2) * m.velocity;
    if (!settings_.features.rotation) continue;
    m.spin += (h * bodies_.inverse_inertia(p)) * load.torque;
    rotate(bodies_.orientation[p], h * m.spin);
  }
}

std::vector<Contact> SoftSphereWorld::contacts() const {
  const double h = settings_.substep;
  std::vector<Contact> out;
  if (!listed_ || bodies_.unsettled()) return out;
  pairs_.each(bodies_, [&](Place i, Place j, const Meeting& m, const Push& p) {
    const native::Ball& ball = bodies_.ball[i];
    out.push_back({bodies_.entries[i].id, bodies_.entries[j].id, false,
                   ball.centre - (ball.radius - m.overlap / 2) * m.normal, m.normal, m.overlap, h * p.force});
  });
  for (const LastingWallContact& c : walls_.lasting())
    out.push_back(
        {bodies_.entries[c.ball].id, c.wall, true, c.point, c.normal, c.overlap, h * walls_.push_of(bodies_, c).force});
  std::stable_sort(out.begin(), out.end(), earlier);
  return out;
}

double SoftSphereWorld::contact_energy() const {
  if (!listed_ || bodies_.unsettled()) return 0;
  return pairs_.energy(bodies_) + walls_.energy(bodies_, settings_.substep);
}

StepWork SoftSphereWorld::work() const {
  return {bodies_.count(), pairs_.count() + walls_.lasting().size(), bonds_.entries().size()};
}

std::vector<ContactMemory> SoftSphereWorld::contact_memory() const {
  std::vector<ContactMemory> out = memory_;
  std::vector<LastingPair> pairs = lasting_;
  if (listed_) pairs_.lasting(pairs);
  const auto id = [&](Place p) { return bodies_.entries[p].id; };
  for (const LastingPair& c : pairs)
    out.push_back({id(c.low), id(c.high), false, Vec3::Zero(), c.springs.sliding, c.springs.rolling});
  for (const LastingWallContact& c : walls_.lasting())
    out.push_back({id(c.ball), c.wall, true, c.normal, c.springs.sliding, c.springs.rolling});
  return out;
}

void SoftSphereWorld::remember(std::span<const ContactMemory> memory) {
  memory_.insert(memory_.end(), memory.begin(), memory.end());
  if (listed_) pairs_.lasting(lasting_);
  listed_ = false;
}

}  // namespace moraine::soft_sphere
