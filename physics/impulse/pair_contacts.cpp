// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/pair_contacts.hpp"

#include <bit>

namespace moraine::impulse {
namespace {

static_assert(sizeof(PairRow) == 80);

std::uint64_t key(const PairRow& r) { return std::uint64_t{r.a} << 32 | r.b; }

void copy(const PairRow& from, std::uint32_t row, PairBatch& to, std::uint32_t lane) {
  to.a[lane] = from.a;
  to.b[lane] = from.b;
  to.row[lane] = row;
  to.inverse_mass_a[lane] = from.inverse_mass_a;
  to.inverse_mass_b[lane] = from.inverse_mass_b;
  for (int axis = 0; axis < 3; ++axis) {
    to.normal[axis][lane] = from.normal[axis];
    to.side[axis][lane] = from.side[axis];
  }
  to.push[lane] = from.push;
  to.approach[lane] = from.approach;
  to.mass[lane] = from.mass;
  to.friction[lane] = from.friction;
  to.firmness[lane] = from.firmness;
  to.yielding[lane] = from.yielding;
  to.rebound[lane] = from.rebound;
  to.gap[lane] = from.gap;
}

/// Rows of this colour may share bodies, and are solved one by one.
constexpr std::uint8_t crowded = 63;

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
  place_close(bodies);
  if (rows_.size() <= meeting_.size()) rows_.resize(meeting_.size() + 1);
  for (const std::uint32_t k : meeting_) count_ += fill(bodies, k, rows_[count_]);
  take_up_impulses();
  choose_colours(bodies.size());
  fill_batches();
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

/// Works out how close pairs lie, and which may meet.
void PairContacts::place_close(const Bodies& bodies) {
  const std::size_t count = close_.size();
  close_.resize((count + batch_lanes - 1) / batch_lanes * batch_lanes, count > 0 ? close_.back() : 0);
  placing_.resize(close_.size() / batch_lanes);
  if (count > 0)
    kernels_.place({pairs_.lower().data(), pairs_.higher().data(), close_.data(), close_.size(),
                    bodies.moving.data()->velocity.data(), bodies.position.data()->data(), placing_.data()});
  meeting_.resize(count + 1);
  std::size_t found = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const PairPlacing& p = placing_[k / batch_lanes];
    meeting_[found] = static_cast<std::uint32_t>(k);
    found += p.gap[k % batch_lanes] < rule_.range(p.closing[k % batch_lanes]);
  }
  meeting_.resize(found);
}

/// Writes the row of a close pair; false if it is not needed.
bool PairContacts::fill(const Bodies& bodies, std::size_t close, PairRow& row) const {
  const PairPlacing& p = placing_[close / batch_lanes];
  const std::size_t lane = close % batch_lanes;
  row.a = pairs_.lower()[close_[close]];
  row.b = pairs_.higher()[close_[close]];
  row.normal = {p.normal[0][lane], p.normal[1][lane], p.normal[2][lane], 0};
  const Weight &a = bodies.weight[row.a], &b = bodies.weight[row.b];
  const PairConstants& law = rule_.of(a.material, b.material);
  row.inverse_mass_a = a.inverse_mass;
  row.inverse_mass_b = b.inverse_mass;
  row.mass = 1 / (a.inverse_mass + b.inverse_mass);
  row.push = 0;
  row.side.setZero();
  const bool shared = bodies.shared(row.a) || bodies.shared(row.b);
  return rule_.prepare(row, p.gap[lane], p.closing[lane], law, shared);
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

/// Rows of a colour share no body. A row gets the first colour that no earlier row of its bodies has, so its colour
/// depends on nothing but what it is connected with.
void PairContacts::choose_colours(std::size_t bodies) {
  taken_.assign(bodies, 0);
  colour_.resize(count_);
  colour_rows_.assign(crowded + 1, 0);
  for (std::size_t k = 0; k < count_; ++k) {
    std::uint64_t &a = taken_[rows_[k].a], &b = taken_[rows_[k].b];
    const auto colour = static_cast<std::uint8_t>(std::min<int>(std::countr_one(a | b), crowded));
    a |= std::uint64_t{1} << colour;
    b |= std::uint64_t{1} << colour;
    colour_[k] = colour;
    ++colour_rows_[colour];
  }
}

/// Every colour begins a batch; each crowded row has one of its own.
void PairContacts::fill_batches() {
  colour_cursor_.assign(crowded + 1, 0);
  std::size_t count = 0;
  for (std::size_t c = 0; c <= crowded; ++c) {
    colour_cursor_[c] = static_cast<std::uint32_t>(batch_lanes * count);
    count += c == crowded ? colour_rows_[c] : (colour_rows_[c] + batch_lanes - 1) / batch_lanes;
  }
  batches_.resize(count);
  for (PairBatch& b : batches_) b.used = 0;
  for (std::uint32_t k = 0; k < count_; ++k) {
    std::uint32_t& lane = colour_cursor_[colour_[k]];
    PairBatch& batch = batches_[lane / batch_lanes];
    copy(rows_[k], k, batch, batch.used++);
    lane += colour_[k] == crowded ? batch_lanes : 1;
  }
  for (PairBatch& b : batches_)
    for (std::uint32_t lane = b.used; lane < batch_lanes; ++lane) copy(rows_[b.row[0]], b.row[0], b, lane);
}

PairTask PairContacts::task(Bodies& bodies) {
  if (bodies.size() == 0) return {};
  return {batches_.data(), batches_.size(), bodies.moving.data()->velocity.data(), bodies.position.data()->data(),
          rule_.friction};
}

void PairContacts::relax(Bodies& bodies) {
  kernels_.relax(task(bodies));
  keep_impulses();
}

void PairContacts::keep_impulses() {
  for (const PairBatch& b : batches_)
    for (std::uint32_t lane = 0; lane < b.used; ++lane) {
      PairRow& row = rows_[b.row[lane]];
      row.push = b.push[lane];
      row.side = {b.side[0][lane], b.side[1][lane], b.side[2][lane], 0};
      row.normal = {b.normal[0][lane], b.normal[1][lane], b.normal[2][lane], 0};
    }
}

}  // namespace moraine::impulse
