// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/world.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "physics/errors.hpp"

namespace moraine::impulse {
namespace {

// Lists last longer with a larger skin, but hold more pairs. [diameters]
constexpr float least_skin = 0.25F, largest_skin = 0.6F;
static_assert(largest_skin > StepNumbers::largest_reach);
constexpr float wall_skins = 2;            ///< that of walls over that of pairs: of a wall only bodies move
constexpr std::size_t many_newcomers = 8;  ///< lists are made anew if more than a share of 1 / 8 is new
constexpr float steps_per_list = 6;        ///< that the fastest body should be free to go
constexpr float sure = 0.998F;             ///< whatever was rounded

}  // namespace

ImpulseWorld::ImpulseWorld(const WorldSettings& settings, const Vec3& origin)
    : settings_(settings),
      units_(settings, origin),
      rule_(settings, units_),
      bodies_(units_),
      pairs_(rule_),
      walls_(rule_, units_, *settings.scene),
      bonds_(*settings.scene, units_),
      turns_(rule_.friction) {}

Slot ImpulseWorld::add(const Body& body) {
  const std::size_t count = bodies_.roster.count() + walls_.walls().size() + 1;
  if (count > settings_.limits.elements)
    throw InputError(
        fmt::format("engine impulse: {} elements, ghosts and boundaries in one sub-model, the limit is {}; use more "
                    "sub-models",
                    count, settings_.limits.elements));
  turns_ |= !body.state.twist.angular.isZero(0);
  return bodies_.add(body, settings_.scene->shapes[body.shape]);
}

void ImpulseWorld::set_state(Slot slot, const ElementState& state) {
  turns_ |= !state.twist.angular.isZero(0);
  bodies_.set_state(bodies_.place(slot), state);
}

void ImpulseWorld::apply_impulse(Slot slot, const Impulse& impulse) {
  turns_ |= !impulse.angular.isZero(0);
  bodies_.push(bodies_.place(slot), impulse);
}

void ImpulseWorld::motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const {
  out.resize(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Place p = bodies_.place(slots[i]);
    out[i] = {units_.position(bodies_.position[p]), bodies_.twist(p)};
  }
}

void ImpulseWorld::step(double t) {
  settle();
  bonds_.break_long(bodies_);
  walls_.walls().move(t);
  keep_lists();
  gather();
  bodies_.fall(rule_.fall, rule_.restitution);
  warm_start();
  for (int k = 0; k < rule_.sweeps; ++k) sweep();
  bodies_.advance(rule_.h, turns_);
  for (int k = 0; k < rule_.relaxing; ++k) relax();
  bonds_.keep_impulses();
  walls_.sum_impulse(bodies_);
}

/// Contacts follow their bodies to new places; those of bodies that left end.
void ImpulseWorld::settle() {
  if (!bodies_.roster.unsettled()) return;
  const std::size_t before = bodies_.roster.settled();
  bodies_.settle();
  pairs_.follow(bodies_.roster.moved());
  walls_.follow(bodies_.roster.moved());
  if (listed_) admit(before);
}

/// A few ghosts more are added to the lists; for anything else lists are made anew. `before`: old places of newcomers
/// begin there.
void ImpulseWorld::admit(std::size_t before) {
  newcomers_.clear();
  bool ghosts = true;
  const std::vector<Place>& order = bodies_.roster.order();
  for (Place p = 0; p < order.size(); ++p) {
    if (order[p] < before) continue;
    newcomers_.push_back(p);
    ghosts &= bodies_.ghost[p] != 0;
  }
  if (!ghosts || many_newcomers * newcomers_.size() > bodies_.size()) return drop_lists();
  listed_at_.resize(bodies_.roster.moved().size());
  native::reorder(listed_at_, order);
  for (const Place p : newcomers_) listed_at_[p] = bodies_.position[p];
  pairs_.insert(bodies_, newcomers_);
}

void ImpulseWorld::drop_lists() {
  listed_ = false;
  pairs_.drop_list();
}

void ImpulseWorld::gather() {
  pairs_.find(bodies_);
  walls_.gather(bodies_);
  bonds_.gather(bodies_, rule_.h);
}

void ImpulseWorld::warm_start() {
  bonds_.warm_start(bodies_.moving.data());
  pairs_.start(bodies_);
  walls_.warm_start(bodies_.moving.data());
}

void ImpulseWorld::sweep() {
  bonds_.sweep(bodies_.moving.data());
  pairs_.sweep(bodies_);
  walls_.sweep(bodies_.moving.data());
}

void ImpulseWorld::relax() {
  bonds_.sweep(bodies_.moving.data());
  pairs_.relax(bodies_);
  walls_.relax();
  walls_.sweep(bodies_.moving.data());
}

/// Lists hold every pair and every wall that may come within the reach of contacts.
void ImpulseWorld::keep_lists() {
  const float way = listed_ ? farthest_way() : 0;
  const bool walls = !listed_ || walls_may_be_near(way);
  if (!walls && !pairs_may_be_near(way)) return;
  skin_ = suitable_skin();
  gone_ += way;
  if (walls) list_walls();
  list_pairs();
}

bool ImpulseWorld::walls_may_be_near(float way) const {
  const float of_walls = static_cast<float>(walls_.walls().moved() / units_.length);
  return gone_ + way + of_walls >= sure * (wall_skin_ - rule_.reach());
}

bool ImpulseWorld::pairs_may_be_near(float way) {
  const float limit = sure * (skin_ - rule_.reach());
  return 2 * way >= limit && drift_.between(listed_at_, bodies_.position) >= limit;
}

float ImpulseWorld::farthest_way() const {
  float way2 = 0;
  for (Place p = 0; p < bodies_.size(); ++p) way2 = std::max(way2, (bodies_.position[p] - listed_at_[p]).squaredNorm());
  return std::sqrt(way2);
}

float ImpulseWorld::suitable_skin() const {
  float fastest2 = 0;
  for (const Moving& m : bodies_.moving) fastest2 = std::max(fastest2, m.velocity.squaredNorm());
  const float way = steps_per_list * rule_.h * std::sqrt(fastest2);
  return std::clamp(rule_.reach() + 2 * way, least_skin, largest_skin);
}

void ImpulseWorld::list_pairs() {
  pairs_.list(bodies_, skin_);
  listed_at_ = bodies_.position;
  drift_.list(listed_at_, 2 * wall_skin_);  // none goes farther than walls allow
  listed_ = true;
}

/// Grid and balls are as large as the bodies themselves, so they are not kept.
void ImpulseWorld::list_walls() {
  wall_skin_ = wall_skins * skin_;
  gone_ = 0;
  std::vector<native::Ball> balls(bodies_.size());
  for (Place p = 0; p < bodies_.size(); ++p)
    balls[p] = {units_.position(bodies_.position[p]), units_.length * static_cast<double>(bodies_.radius(p))};
  const double skin = static_cast<double>(wall_skin_) * units_.length;
  native::SizedGrid grid;
  grid.build(balls, skin);
  walls_.list(grid, balls, bodies_.ghost, skin);
}

Contact ImpulseWorld::contact(const PairRow& row) const {
  const Vec3 between = wide(bodies_.position[row.a] - bodies_.position[row.b]);
  const double radius = bodies_.radius(row.a);
  Contact c;
  c.a = bodies_.roster.id(row.a);
  c.b = bodies_.roster.id(row.b);
  c.normal = wide(row.normal);
  c.overlap = units_.length * (radius + bodies_.radius(row.b) - between.norm());
  c.point = units_.position(bodies_.position[row.a]) - (units_.length * radius - c.overlap / 2) * c.normal;
  c.impulse = units_.momentum() * wide(row.push * row.normal + row.side);
  return c;
}

Contact ImpulseWorld::contact(const WallRow& row) const {
  const double radius = units_.length * static_cast<double>(bodies_.radius(row.ball));
  Contact c;
  c.a = bodies_.roster.id(row.ball);
  c.b = row.wall;
  c.with_boundary = true;
  c.normal = wide(row.normal);
  c.overlap = -units_.length * static_cast<double>(row.gap);
  c.point = units_.position(bodies_.position[row.ball]) - (radius - c.overlap) * c.normal;
  c.impulse = units_.momentum() * wide(row.push * row.normal + row.side);
  return c;
}

std::vector<Contact> ImpulseWorld::contacts() const {
  std::vector<Contact> out;
  each_contact([&](const Contact& c) { out.push_back(c); });
  std::stable_sort(out.begin(), out.end(), earlier);
  return out;
}

void ImpulseWorld::each_contact(const std::function<void(const Contact&)>& visit) const {
  if (bodies_.roster.unsettled()) return;
  const auto look_at = [&](const auto& row) {
    const Contact c = contact(row);
    if (c.overlap > 0 || !c.impulse.isZero(0)) visit(c);
  };
  pairs_.each_row(look_at);
  for (const WallRow& row : walls_.rows()) look_at(row);
}

StepWork ImpulseWorld::work() const {
  return {bodies_.roster.count(), pairs_.count() + walls_.rows().size(), bonds_.entries().size()};
}

}  // namespace moraine::impulse
