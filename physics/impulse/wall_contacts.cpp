// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/wall_contacts.hpp"

#include <algorithm>
#include <limits>

#include "physics/native/room.hpp"

namespace moraine::impulse {
namespace {

static_assert(sizeof(WallRow) == 96);

/// Cosine of the angle by which a normal may turn in a step and still belong to the same contact: a ball that rolls
/// from one triangle of a mesh to the next keeps its impulses.
constexpr float same_contact = 0.9F;

template <class A, class B>
bool earlier_place(const A& a, const B& b) {
  return std::pair(a.ball, a.wall) < std::pair(b.ball, b.wall);
}

template <bool Friction>
void apply(const WallRow& row, Moving& ball, const Vec& impulse, const Vec& side) {
  ball.velocity += row.inverse_mass * impulse;
  if constexpr (Friction) ball.turning += row.inverse_mass * turn(side, row.normal);
}

}  // namespace

void WallContacts::follow(std::span<const Place> moved) {
  for (WallRow& row : rows_) row.ball = moved[row.ball];
  std::erase_if(rows_, [](const WallRow& row) { return row.ball == nowhere; });
  for (native::WallCandidate& c : candidates_) c.ball = moved[c.ball];
  std::erase_if(candidates_, [](const native::WallCandidate& c) { return c.ball == nowhere; });
}

void WallContacts::gather(const Bodies& bodies) {
  std::swap(rows_, before_);
  rows_.clear();
  passed_ = 0;
  for (std::size_t begin = 0, end = 0; begin < candidates_.size(); begin = end) {
    while (end < candidates_.size() && !earlier_place(candidates_[begin], candidates_[end])) ++end;
    meet(bodies, Group(candidates_).subspan(begin, end - begin));
  }
}

/// Balls are inflated, so that walls are met before they are touched.
void WallContacts::meet(const Bodies& bodies, Group group) {
  const auto [place, wall, surface] = group.front();
  const native::Ball ball{units_.position(bodies.position[place]),
                          static_cast<double>(bodies.radius(place) + rule_.reach()) * units_.length};
  while (passed_ < before_.size() && earlier_place(before_[passed_], group.front())) ++passed_;
  native::find_touches(walls_[wall], ball, group, touches_);
  for (const native::Nearest& touch : touches_) {
    WallRow row;
    row.ball = place;
    row.wall = wall;
    add(bodies, row, touch);
  }
}

void WallContacts::add(const Bodies& bodies, WallRow row, const native::Nearest& touch) {
  const native::Wall& wall = walls_[row.wall];
  const float gap = static_cast<float>(touch.distance / units_.length) - bodies.radius(row.ball);
  row.normal = narrow(touch.normal);
  row.velocity = narrow(wall.velocity(touch.point) / units_.velocity());
  const float closing = row.normal.dot(row.velocity - bodies.moving[row.ball].velocity);
  const PairConstants& law = rule_.of(bodies.material[row.ball], wall.material());
  row.inverse_mass = bodies.moving[row.ball].inverse_mass();
  row.mass = 1 / row.inverse_mass;
  const bool carries = bodies.carries[row.ball] != 0;
  if (!rule_.prepare(row, gap, closing, law, carries)) return;
  const float limit = take_up(row);
  if (carries) row.rebound = limit > rule_.numbers().threshold ? std::min(row.rebound, limit) : 0;
  native::append(rows_, row);
}

/// The impulses of the row of the step before whose normal is nearest. Returns how fast a shared ball may rebound,
/// as in the kernels for pairs.
float WallContacts::take_up(WallRow& row) const {
  float best = same_contact;
  float limit = std::numeric_limits<float>::infinity();
  for (std::size_t k = passed_; k < before_.size() && !earlier_place(row, before_[k]); ++k) {
    const WallRow& old = before_[k];
    const float cosine = old.normal.dot(row.normal);
    if (cosine > same_contact && old.push > 0) limit = std::min(limit, StepNumbers::again * old.rebound);
    if (cosine <= best || old.rebound > 0) continue;
    best = cosine;
    row.push = old.push;
    row.side = old.side - old.side.dot(row.normal) * row.normal;
  }
  return limit;
}

void WallContacts::warm_start(Moving* bodies) const {
  for (const WallRow& row : rows_) apply<true>(row, bodies[row.ball], row.push * row.normal + row.side, row.side);
}

void WallContacts::sweep(Moving* bodies) {
  if (rule_.friction)
    sweep_all<true>(bodies);
  else
    sweep_all<false>(bodies);
}

template <bool Friction>
void WallContacts::sweep_all(Moving* bodies) {
  for (WallRow& row : rows_) {
    Moving& ball = bodies[row.ball];
    Vec slip = ball.velocity - row.velocity;
    if constexpr (Friction) slip -= ball.turning.cross3(row.normal);
    const Change change = correct<Friction>(row, slip);
    apply<Friction>(row, ball, change.impulse, change.side);
  }
}

void WallContacts::relax() {
  for (WallRow& row : rows_) impulse::relax(row);
}

/// Impulses act on a ball at its radius.
void WallContacts::sum_impulse(const Bodies& bodies) {
  impulse_ = {};
  work_ = 0;
  for (const WallRow& row : rows_) {
    const Vec3 given = units_.momentum() * wide(row.push * row.normal + row.side);
    const Vec3 arm = units_.length * static_cast<double>(bodies.radius(row.ball)) * wide(row.normal);
    work_ += units_.velocity() * given.dot(wide(row.velocity));
    impulse_ += {given, (units_.position(bodies.position[row.ball]) - arm).cross(given)};
  }
}

}  // namespace moraine::impulse
