// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/pair_contacts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace moraine::impulse {
namespace {

static_assert(sizeof(PairRow) == 48);

void put(const PairRow& row, std::uint32_t pair, PairBatch& to, std::size_t lane) {
  to.a[lane] = row.a;
  to.b[lane] = row.b;
  to.pair[lane] = pair;
  to.push[lane] = row.push;
  to.rebound[lane] = row.rebound;
  for (int axis = 0; axis < 3; ++axis) {
    to.normal[axis][lane] = row.normal[axis];
    to.side[axis][lane] = row.side[axis];
  }
}

bool spare(const PairBatch& batch, std::size_t lane) { return lane > 0 && batch.pair[lane] == batch.pair[0]; }

}  // namespace

void PairContacts::list(const Bodies& bodies, float skin) {
  pairs_.build(bodies.position, bodies.ghost, skin);
  listed_ = true;
  shifted_ = true;
}

void PairContacts::follow(std::span<const Place> moved) {
  const auto renew = [&](Place& p) { p = p == nowhere ? nowhere : moved[p]; };
  for (std::size_t k = 0; k < batches_.size(); ++k)
    for (std::size_t lane = 0; lane < batch_lanes; ++lane) renew(batches_[k].a[lane]), renew(batches_[k].b[lane]);
  if (listed_) pairs_.follow(moved);
  shifted_ = true;
}

void PairContacts::insert(const Bodies& bodies, std::span<const Place> ghosts) {
  pairs_.insert(bodies.position, bodies.ghost, ghosts);
  shifted_ = true;
}

std::vector<PairRow> PairContacts::rows() const {
  std::vector<PairRow> out;
  out.reserve(batches_.size() * batch_lanes);
  each_row([&](const PairRow& r) { out.push_back(r); });
  return out;
}

/// Where the contacts are in the batches, in the order of the list.
std::vector<std::uint32_t> PairContacts::lanes() const {
  std::vector<std::uint32_t> out;
  out.reserve(batches_.size() * batch_lanes);
  for (std::uint32_t at = 0; at < batches_.size() * batch_lanes; ++at) {
    const PairBatch& batch = batches_[at / batch_lanes];
    const std::size_t lane = at % batch_lanes;
    if (!spare(batch, lane) && batch.a[lane] != nowhere && batch.b[lane] != nowhere) out.push_back(at);
  }
  const auto pair = [&](std::uint32_t at) { return batches_[at / batch_lanes].pair[at % batch_lanes]; };
  std::sort(out.begin(), out.end(), [&](std::uint32_t p, std::uint32_t q) { return pair(p) < pair(q); });
  return out;
}

PairRow PairContacts::row(std::uint32_t at) const {
  const PairBatch& from = batches_[at / batch_lanes];
  const std::size_t lane = at % batch_lanes;
  PairRow row;
  row.a = from.a[lane];
  row.b = from.b[lane];
  row.push = from.push[lane];
  row.rebound = std::abs(from.rebound[lane]);
  for (int axis = 0; axis < 3; ++axis) {
    row.normal[axis] = from.normal[axis][lane];
    row.side[axis] = from.side[axis][lane];
  }
  return row;
}

/// In batches of one group each.
void PairContacts::restore(const Bodies& bodies, std::span<const PairRow> rows) {
  batches_.renew();
  batches_.take_rest();
  for (std::uint32_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    const ElementId group = group_of(bodies, rows[begin].a);
    while (end < rows.size() && end < begin + batch_lanes && group_of(bodies, rows[end].a) == group) ++end;
    PairBatch& batch = batches_.add(1).front();
    for (std::uint32_t lane = 0; lane < batch_lanes; ++lane) {
      const std::uint32_t from = begin + lane < end ? begin + lane : begin;
      put(rows[from], from, batch, lane);
    }
    batches_.end_group(group);
  }
  listed_ = false;
  shifted_ = true;
  meeting_.count = rows.size();
}

BodyArrays PairContacts::arrays(Bodies& bodies) {
  return {bodies.moving.data()->velocity.data(), numbers_of(bodies.position), bodies.material.data(),
          bodies.carries.data(), numbers_of(bodies.before)};
}

PairTable PairContacts::table() const { return {pairs_.lower(), pairs_.higher(), pairs_.size()}; }

/// In pieces: what is close stays in the processor's cache, and room is made for those that meet, not for all.
void PairContacts::find(Bodies& bodies) {
  constexpr std::size_t piece = 4096;
  std::array<std::uint32_t, piece + batch_lanes> close;
  meeting_.count = 0;
  PairFindTask task{arrays(bodies), table(), rule_.numbers(), laws(), features(), 0, 0, close.data()};
  for (; task.begin < pairs_.size(); task.begin = task.end) {
    task.end = std::min(task.begin + piece, pairs_.size());
    task.out = meeting_.more(task.end - task.begin + batch_lanes);
    meeting_.count += kernels_.find(task);
  }
}

/// Group by group: contacts whose lower bodies have ids of one range, so that bodies and contacts of a group stay in
/// the processor's cache.
void PairContacts::start(Bodies& bodies) {
  taken_.assign(bodies.size(), {});
  batches_.renew();
  const std::span<const std::uint32_t> all = meeting_.all();
  for (auto begin = all.begin(), end = begin; begin < all.end(); begin = end) {
    const ElementId group = group_of(bodies, pairs_.lower()[*begin]);
    end = std::partition_point(begin, all.end(),
                               [&](std::uint32_t k) { return group_of(bodies, pairs_.lower()[k]) == group; });
    const std::span<const std::uint32_t> contacts(begin, end);
    carry_on(group, contacts);
    choose_colours(contacts, static_cast<std::uint32_t>(begin - all.begin()) + 1);
    start_group(bodies);
    batches_.end_group(group);
  }
  batches_.take_rest();
  shifted_ = false;
}

void PairContacts::carry_on(ElementId group, std::span<const std::uint32_t> contacts) {
  carried_.begin(table(), contacts.front(), contacts.back());
  if (shifted_) carried_.index();
  batches_.take(group, [&](std::span<PairBatch> old) {
    if (shifted_) carried_.find_places(old);
    carried_.take(old);
  });
}

ElementId PairContacts::group_of(const Bodies& bodies, Place lower) { return bodies.roster.id(lower) / group_ids; }

/// Contacts of a colour share no body. A contact gets the first colour that no earlier contact of its bodies in the
/// group has, so the order of a body's contacts depends on nothing but what it is connected with.
void PairContacts::choose_colours(std::span<const std::uint32_t> pairs, std::uint32_t group) {
  for (Places& c : coloured_) c.count = 0;
  const auto taken = [&](Place body) -> std::uint32_t& {
    if (taken_[body].group != group) taken_[body] = {group, 0};
    return taken_[body].colours;
  };
  for (const std::uint32_t k : pairs) {
    std::uint32_t &a = taken(pairs_.lower()[k]), &b = taken(pairs_.higher()[k]);
    const auto colour = static_cast<std::size_t>(std::min<int>(std::countr_one(a | b), crowded));
    a |= std::uint32_t{1} << colour;
    b |= std::uint32_t{1} << colour;
    coloured_[colour].add(k);
  }
}

/// Every colour begins a batch; each crowded contact has one of its own.
void PairContacts::start_group(Bodies& bodies) {
  PairStartTask task{arrays(bodies), table(), rule_.numbers(), laws(), features(), carried_.pairs()};
  for (std::size_t c = 0; c < crowded && coloured_[c].count > 0; ++c) fill(task, coloured_[c].all());
  for (const std::uint32_t& k : coloured_[crowded].all()) fill(task, {&k, 1});
}

void PairContacts::fill(PairStartTask& task, std::span<const std::uint32_t> pairs) {
  while (!pairs.empty()) {
    const std::span<PairBatch> room = batches_.add((pairs.size() + batch_lanes - 1) / batch_lanes);
    task.batches = room.data();
    task.pairs = pairs.data();
    task.count = std::min(pairs.size(), room.size() * batch_lanes);
    kernels_.start(task);
    pairs = pairs.subspan(task.count);
  }
}

void PairContacts::solve(void (*kernel)(const PairTask&), Bodies& bodies) {
  PairTask task{arrays(bodies), nullptr, 0, rule_.numbers(), laws(), features()};
  batches_.each([&](std::span<PairBatch> batches) {
    task.batches = batches.data();
    task.count = batches.size();
    kernel(task);
  });
}

}  // namespace moraine::impulse
