// SPDX-License-Identifier: Apache-2.0
// Rest: a sub-model in which nothing moves, and whose neighbours send it nothing new, does not advance. Its time stands
// still: it goes on telling its neighbours what it told them last.
#include "ghosting/rest.hpp"

#include <algorithm>
#include <cmath>

#include "ghosting/sub_model.hpp"

namespace moraine {
namespace {

/// What gravity, boundaries and neighbours gave in a round, on average since `then`: momentum that did not change was
/// balanced by neighbours, whose side of it is in their own accounts.
Ledger per_round(const Ledger& then, const Ledger& now, double rounds) {
  const auto mean = [&](const auto& a, const auto& b) { return (b - a) / rounds; };
  Ledger out;
  out.given.linear = mean(then.given.linear, now.given.linear) - mean(then.momentum.linear, now.momentum.linear);
  out.given.angular = mean(then.given.angular, now.given.angular) - mean(then.momentum.angular, now.momentum.angular);
  out.exchanged = mean(then.exchanged, now.exchanged);
  out.exchanged_angular = mean(then.exchanged_angular, now.exchanged_angular);
  out.from_boundaries = mean(then.from_boundaries, now.from_boundaries);
  return out;
}

double radius_of(const Boundary& boundary, const Scene& scene) {
  if (const auto* solid = std::get_if<Solid>(&boundary.geometry)) return scene.shapes[solid->shape].bounding_radius;
  double radius = 0;
  if (const auto* mesh = std::get_if<TriangleMesh>(&boundary.geometry))
    for (const Vec3& v : mesh->vertices) radius = std::max(radius, v.norm());
  return radius;
}

}  // namespace

RestLimits rest_limits(const WorldSettings& world, double threshold) {
  const double stillness = std::max(0.1, 4 * threshold) * world.time_unit;
  return {threshold * world.length_unit / world.time_unit, 0.1 * threshold * world.length_unit,
          std::max<std::int64_t>(10, std::llround(stillness / world.substep))};
}

DrivenBoundaries::DrivenBoundaries(const Scene& scene) {
  for (const Boundary& b : scene.boundaries)
    if (b.motion.moves()) driven_.push_back({&b, radius_of(b, scene)});
}

double DrivenBoundaries::distance(const Driven& driven, const Pose& pose, const Bounds& box) {
  const auto* plane = std::get_if<Plane>(&driven.boundary->geometry);
  if (!plane) return box.distance(pose.position) - driven.radius;
  const Vec3 normal = pose.orientation * plane->normal, point = pose.position + pose.orientation * plane->point;
  const Vec3 middle = (box.min + box.max) / 2, half = (box.max - box.min) / 2;
  return normal.dot(middle - point) - normal.cwiseAbs().dot(half);
}

bool DrivenBoundaries::near(const Bounds& box, double reach, double t) const {
  return std::any_of(driven_.begin(), driven_.end(), [&](const Driven& d) {
    const Motion& motion = d.boundary->motion;
    const Twist now = motion.twist(d.boundary->pose, t);
    if (now.linear.isZero(0) && now.angular.isZero(0)) return false;
    return distance(d, motion.pose(d.boundary->pose, t), box) <= reach;
  });
}

bool SubModel::driven(const runtime::Round& round) const {
  return context_.driven.near(bounds_, context_.world.length_unit,
                              static_cast<double>(round.number) * context_.world.substep);
}

/// Spheres that spin in their place move nothing: without rolling friction they may do so for ever.
bool SubModel::still(const runtime::Round& round) const {
  const double limit = context_.rest.speed;
  if (max_speed_ > limit || driven(round)) return false;
  if (context_.world.features.spheres_only) return true;
  for (std::size_t i = 0; i < motions_.size(); ++i)
    if (motions_[i].twist.angular.norm() * radius_[i] > limit) return false;
  return true;
}

/// At the end of a round: falls asleep when it has been still for long enough.
void SubModel::watch_rest(const runtime::Round& round) {
  if (!context_.rest.on() || resting_) return;
  if (!still(round)) return wake();
  if (++still_rounds_ == 1) still_since_ = ledger();
  if (still_rounds_ <= context_.rest.rounds) return;
  resting_ = true;
  at_rest_ = per_round(still_since_, ledger(), static_cast<double>(context_.rest.rounds));
}

void SubModel::wake() {
  resting_ = false;
  still_rounds_ = 0;
}

/// What a round at rest adds to the accounts.
void SubModel::rest_account() {
  ledger_ += at_rest_;
  rested_ += members_.size();
}

/// Whether anything has come that this sub-model did not rest with.
bool SubModel::disturbed(const runtime::Round& round, const runtime::Port& port) {
  if (driven(round)) return true;
  return std::any_of(host_links_.begin(), host_links_.end(), [&](HostLink& link) {
    bound_message_.read(port.received(link.owner));
    const bool told = link.owner_rests && bound_message_.resting;
    link.owner_rests = bound_message_.resting;
    link.bounds = bound_message_.bounds;
    link.max_speed = bound_message_.max_speed;
    return !told && disturbs(link, bound_message_);
  });
}

bool SubModel::disturbs(const HostLink& link, const BoundMessage& message) const {
  const RestLimits& limits = context_.rest;
  const bool same = std::equal(link.ghosts.begin(), link.ghosts.end(), message.ghosts.begin(), message.ghosts.end(),
                               [&](const Ghost& g, const GhostOrder& order) {
                                 const Twist& was = g.start.twist;
                                 return g.element == order.element &&
                                        (order.start.pose.position - g.start.pose.position).norm() <= limits.shift &&
                                        (order.start.twist.linear - was.linear).norm() <= limits.speed;
                               });
  return !same || std::any_of(link.bonds.begin(), link.bonds.end(), [&](const CrossBond& b) {
    return std::binary_search(message.broken_bonds.begin(), message.broken_bonds.end(), b.bond);
  });
}

void SubModel::mirror_at_rest(const runtime::Round& round, const runtime::Port& port) {
  bool pushed = false;
  for (OwnerLink& link : owner_links_)
    if (receive_at_rest(link, port.received(link.host), round.opening())) pushed = true;
  if (!round.opening()) rest_account();
  if (pushed) wake();
}

/// Results are compared with those of the last round before this sub-model fell asleep, which stay. True if they
/// differ.
bool SubModel::receive_at_rest(OwnerLink& link, std::span<const std::byte> bytes, bool opening) {
  step_message_.read(bytes);
  receive_border(link);
  if (opening || step_message_.resting) return false;
  note_broken(step_message_.broken_bonds);
  forget_bonds(step_message_.broken_bonds);
  return pushes(link, step_message_);
}

/// Whether a host's copies are pushed otherwise than when this sub-model fell asleep, or a bond to it broke.
bool SubModel::pushes(const OwnerLink& link, const StepMessage& message) const {
  const bool same =
      std::equal(link.results.begin(), link.results.end(), message.results.begin(), message.results.end(),
                 [&](const GhostResult& was, const GhostResult& now) {
                   return was.element == now.element &&
                          (now.motion.twist.linear - was.motion.twist.linear).norm() <= context_.rest.speed;
                 });
  return !same || !message.broken_bonds.empty();
}

}  // namespace moraine
