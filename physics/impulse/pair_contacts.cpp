// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/pair_contacts.hpp"

#include <numeric>

namespace moraine::impulse {
namespace {

static_assert(sizeof(PairRow) == 80);

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
  find_close(bodies);
  if (rows_.size() <= close_.size()) rows_.resize(close_.size() + 1);
  for (const std::uint32_t k : close_) count_ += fill(bodies, k, rows_[count_]);
  take_up_impulses();
  put_in_order();
}

/// Without branches: which pairs are close cannot be guessed.
void PairContacts::find_close(const Bodies& bodies) {
  const Place *low = pairs_.lower().data(), *high = pairs_.higher().data();
  const Vec* position = bodies.position.data();
  close_.resize(pairs_.size() + 1);
  std::size_t found = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Vec &a = position[low[k]], &b = position[high[k]];
    const float limit = a.w() + b.w() + rule_.reach();
    close_[found] = static_cast<std::uint32_t>(k);
    found += three(a - b).squaredNorm() < limit * limit;
  }
  close_.resize(found);
}

/// Writes the row of a pair; false if it is not needed.
bool PairContacts::fill(const Bodies& bodies, std::size_t pair, PairRow& row) const {
  row.a = pairs_.lower()[pair];
  row.b = pairs_.higher()[pair];
  const Vec between = three(bodies.position[row.a] - bodies.position[row.b]);
  const float distance = between.norm(), gap = distance - bodies.radius(row.a) - bodies.radius(row.b);
  row.normal = distance > 0 ? Vec((1 / distance) * between) : Vec(Vec::UnitZ());
  const float closing = row.normal.dot(bodies.moving[row.b].velocity - bodies.moving[row.a].velocity);
  const Weight &a = bodies.weight[row.a], &b = bodies.weight[row.b];
  const PairConstants& law = rule_.of(a.material, b.material);
  row.inverse_mass_a = a.inverse_mass;
  row.inverse_mass_b = b.inverse_mass;
  row.mass = 1 / (a.inverse_mass + b.inverse_mass);
  row.push = 0;
  row.side.setZero();
  return rule_.prepare(row, gap, closing, law, bodies.shared(row.a) || bodies.shared(row.b));
}

/// From the rows of the step before, turned with the contact. What made an impact does not go on.
void PairContacts::take_up_impulses() {
  std::size_t passed = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    PairRow& row = rows_[k];
    while (passed < count_before_ && key(before_[passed]) < key(row)) ++passed;
    if (passed == count_before_) return;
    const PairRow& old = before_[passed];
    if (key(old) != key(row) || old.rebound > 0) continue;
    row.push = old.push;
    row.side = old.side - old.side.dot(row.normal) * row.normal;
  }
}

/// First the first contacts of all bodies, then their second ones, and so on: the processor can work on several rows at
/// once where neighbours in the order do not share a body.
void PairContacts::put_in_order() {
  order_end_.clear();
  rank_.resize(count_);
  for (std::size_t k = 0; k < count_; ++k) {
    rank_[k] = k > 0 && rows_[k - 1].a == rows_[k].a ? rank_[k - 1] + 1 : 0;
    if (rank_[k] >= order_end_.size()) order_end_.push_back(0);
    ++order_end_[rank_[k]];
  }
  std::exclusive_scan(order_end_.begin(), order_end_.end(), order_end_.begin(), 0U);
  order_.resize(count_);
  for (std::size_t k = 0; k < count_; ++k) order_[order_end_[rank_[k]]++] = static_cast<std::uint32_t>(k);
}

void PairContacts::warm_start(Moving* bodies) const {
  for (const PairRow& row : rows()) {
    if (row.push == 0) continue;
    Moving &a = bodies[row.a], &b = bodies[row.b];
    apply(row, a, b, row.push * row.normal + row.side);
    if (rule_.friction) apply_turn(row, a, b, row.side);
  }
}

void PairContacts::sweep(Moving* bodies) {
  if (rule_.friction)
    sweep_all<true>(bodies);
  else
    sweep_all<false>(bodies);
}

template <bool Friction>
void PairContacts::sweep_all(Moving* bodies) {
  for (const std::uint32_t k : order_) {
    PairRow& row = rows_[k];
    Moving &a = bodies[row.a], &b = bodies[row.b];
    const Change change = correct<Friction>(row, slip<Friction>(row, a, b));
    apply(row, a, b, change.impulse);
    if constexpr (Friction) apply_turn(row, a, b, change.side);
  }
}

void PairContacts::relax(const Bodies& bodies) {
  for (std::size_t k = 0; k < count_; ++k) {
    PairRow& row = rows_[k];
    impulse::relax(row);
    if (row.push > 0 && row.gap > 0) row.normal = normal_between(bodies, row.a, row.b);
  }
}

}  // namespace moraine::impulse
