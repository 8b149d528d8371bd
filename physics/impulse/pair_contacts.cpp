// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/pair_contacts.hpp"

namespace moraine::impulse {
namespace {

static_assert(sizeof(PairRow) == 64);

std::uint64_t key(const PairRow& r) { return std::uint64_t{r.a} << 32 | r.b; }

template <bool Friction>
Vec slip(const PairRow& row, const Moving& a, const Moving& b) {
  const Vec apart = a.velocity - b.velocity;
  if constexpr (!Friction) return apart;
  return apart - (a.turning + b.turning).cross3(row.normal);
}

void apply(const PairRow& row, Moving& a, Moving& b, const Vec& impulse) {
  a.velocity += row.inverse_mass_a * impulse;
  b.velocity -= row.inverse_mass_b * impulse;
}

void apply_turn(const PairRow& row, Moving& a, Moving& b, const Vec& side) {
  const Vec turned = turn(side, row.normal);
  a.turning += row.inverse_mass_a * turned;
  b.turning += row.inverse_mass_b * turned;
}

Vec normal_between(const Bodies& bodies, Place a, Place b) {
  const Vec between = three(bodies.position[a] - bodies.position[b]);
  const float distance = between.norm();
  return distance > 0 ? Vec(between / distance) : Vec(Vec::UnitZ());
}

}  // namespace

void PairContacts::follow(std::span<const Place> moved) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    PairRow row = rows_[k];
    row.a = moved[row.a];
    row.b = moved[row.b];
    if (row.a != nowhere && row.b != nowhere) rows_[kept++] = row;
  }
  count_ = kept;
}

void PairContacts::restore(std::vector<PairRow> rows) {
  rows_ = std::move(rows);
  count_ = rows_.size();
}

void PairContacts::gather(const Bodies& bodies) {
  std::swap(rows_, before_);
  count_before_ = std::exchange(count_, 0);
  passed_ = 0;
  if (rows_.size() < pairs_.size()) rows_.resize(pairs_.size());
  if (rule_.restitution && rebound_.size() < pairs_.size()) rebound_.resize(pairs_.size());
  const Place *low = pairs_.lower().data(), *high = pairs_.higher().data();
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Place a = low[k], b = high[k];
    const Vec between = bodies.position[a] - bodies.position[b];
    const float radii = bodies.radius(a) + bodies.radius(b), limit = radii + StepRule::reach;
    const float distance2 = three(between).squaredNorm();
    if (!(distance2 < limit * limit)) continue;
    const float distance = std::sqrt(distance2), gap = distance - radii;
    const Vec normal = distance > 0 ? Vec(three(between) / distance) : Vec(Vec::UnitZ());
    const float closing = normal.dot(bodies.moving[b].velocity - bodies.moving[a].velocity);
    if (!rule_.near(gap, closing)) continue;
    const Weight &wa = bodies.weight[a], &wb = bodies.weight[b];
    const PairConstants& law = rule_.of(wa.material, wb.material);
    PairRow& row = rows_[count_];
    row.normal = normal;
    row.a = a;
    row.b = b;
    row.inverse_mass_a = wa.inverse_mass;
    row.inverse_mass_b = wb.inverse_mass;
    row.approach = rule_.approach(gap);
    row.mass = 1 / (wa.inverse_mass + wb.inverse_mass);
    row.friction = law.friction;
    if (rule_.restitution) rebound_[count_] = rule_.rebound(law.restitution, closing);
    take_up(row);
    ++count_;
  }
}

/// The impulses of the step before, turned with the contact.
void PairContacts::take_up(PairRow& row) {
  row.push = 0;
  row.side.setZero();
  while (passed_ < count_before_ && key(before_[passed_]) < key(row)) ++passed_;
  if (passed_ == count_before_ || key(before_[passed_]) != key(row)) return;
  const PairRow& old = before_[passed_];
  row.push = old.push;
  row.side = old.side - old.side.dot(row.normal) * row.normal;
}

void PairContacts::warm_start(Moving* bodies) const {
  for (const PairRow& row : rows()) {
    if (row.push == 0) continue;
    Moving &a = bodies[row.a], &b = bodies[row.b];
    apply(row, a, b, row.push * row.normal + row.side);
    if (rule_.friction) apply_turn(row, a, b, row.side);
  }
}

void PairContacts::sweep(Moving* bodies, const Softness& softness) {
  if (rule_.friction)
    sweep_all<true>(bodies, softness);
  else
    sweep_all<false>(bodies, softness);
}

template <bool Friction>
void PairContacts::sweep_all(Moving* bodies, const Softness& softness) {
  for (std::size_t k = 0; k < count_; ++k) {
    PairRow& row = rows_[k];
    Moving &a = bodies[row.a], &b = bodies[row.b];
    const Change change = correct<Friction>(row, slip<Friction>(row, a, b), softness);
    apply(row, a, b, change.impulse);
    if constexpr (Friction) apply_turn(row, a, b, change.side);
  }
}

void PairContacts::relax_from(const Bodies& bodies) {
  for (std::size_t k = 0; k < count_; ++k) {
    PairRow& row = rows_[k];
    const bool met = row.approach > 0, bounces = rule_.restitution && rebound_[k] > 0;
    row.approach = relaxed_approach(row, bounces ? rebound_[k] : 0);
    if (row.push > 0 && (met || bounces)) row.normal = normal_between(bodies, row.a, row.b);
  }
}

}  // namespace moraine::impulse
