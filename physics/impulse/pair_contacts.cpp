// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/pair_contacts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace moraine::impulse {
namespace {

static_assert(sizeof(PairRow) == 48);

constexpr std::array<float, 4> nothing{};

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

/// As the kernels write it.
std::array<float, 4> carried_by(const PairRow& row) {
  if (row.rebound > 0) return {0, 0, 0, row.push > 0 ? -row.rebound : 0};
  return {row.side[0], row.side[1], row.side[2], row.push};
}

bool spare(const PairBatch& batch, std::size_t lane) { return lane > 0 && batch.pair[lane] == batch.pair[0]; }

}  // namespace

void PairContacts::list(const Bodies& bodies, float skin) {
  if (listed_) put_away();
  pairs_.build(bodies.position, bodies.ghost, skin);
  take_out();
  listed_ = true;
}

/// What pairs carry, without the list.
void PairContacts::put_away() {
  away_.clear();
  away_.reserve(meeting_.count);
  for (const std::uint32_t k : meeting_.all()) {
    if (carried_[k] == nothing) continue;
    carried_[away_.size()] = carried_[k];
    away_.push_back(pairs_.pair(k));
  }
}

/// Back into a new list, which holds at least the pairs that are in contact.
void PairContacts::take_out() {
  meeting_.count = 0;
  std::uint32_t k = 0;
  for (std::size_t j = 0; j < away_.size(); ++j) {
    while (k < pairs_.size() && pairs_.pair(k) < away_[j]) ++k;
    if (k == pairs_.size()) break;
    if (pairs_.pair(k) != away_[j]) continue;
    carried_[meeting_.count] = carried_[j];
    meeting_.add(k);
  }
  carried_.resize(pairs_.size());
  spread_carried();
  away_.clear();
}

/// From the front of the list to the places of those in contact; backwards, as none lies before its place in the front.
void PairContacts::spread_carried() {
  std::size_t end = carried_.size();
  for (std::size_t j = meeting_.count; j-- > 0;) {
    const std::size_t k = meeting_.at[j];
    std::fill(carried_.begin() + k + 1, carried_.begin() + end, nothing);
    carried_[k] = carried_[j];
    end = k;
  }
  std::fill(carried_.begin(), carried_.begin() + end, nothing);
}

void PairContacts::follow(std::span<const Place> moved) {
  const auto renew = [&](Place& p) { p = p == nowhere ? nowhere : moved[p]; };
  for (std::size_t k = 0; k < batch_count_; ++k)
    for (std::size_t lane = 0; lane < batch_lanes; ++lane) renew(batches_[k].a[lane]), renew(batches_[k].b[lane]);
  if (listed_)
    follow_list(moved);
  else
    follow_away(moved);
}

void PairContacts::follow_away(std::span<const Place> moved) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < away_.size(); ++k) {
    const NearList::Pair now{moved[away_[k][0]], moved[away_[k][1]]};
    if (now[0] == nowhere || now[1] == nowhere) continue;
    carried_[kept] = carried_[k];
    away_[kept++] = now;
  }
  away_.resize(kept);
}

/// What was in contact stays in contact, at a new place in the list.
void PairContacts::follow_list(std::span<const Place> moved) {
  const std::size_t count = std::exchange(meeting_.count, 0);
  std::size_t next = 0;
  pairs_.follow(moved, [&](std::size_t old, std::size_t now) {
    carried_[now] = carried_[old];
    while (next < count && meeting_.at[next] < old) ++next;
    if (next < count && meeting_.at[next] == old)
      meeting_.at[meeting_.count++] = static_cast<std::uint32_t>(now), ++next;
  });
  carried_.resize(pairs_.size());
}

void PairContacts::insert(const Bodies& bodies, std::span<const Place> ghosts) {
  std::size_t next = meeting_.count;
  pairs_.insert(bodies.position, bodies.ghost, ghosts, [&](std::size_t old, std::size_t now) {
    carried_.resize(std::max(carried_.size(), now + 1));
    carried_[now] = carried_[old];
    carried_[old] = nothing;
    while (next > 0 && meeting_.at[next - 1] > old) --next;
    if (next > 0 && meeting_.at[next - 1] == old) meeting_.at[--next] = static_cast<std::uint32_t>(now);
  });
  carried_.resize(pairs_.size());
}

void PairContacts::drop_list() {
  if (listed_) put_away();
  listed_ = false;
}

std::vector<PairRow> PairContacts::rows() const {
  std::vector<PairRow> out;
  out.reserve(batch_count_ * batch_lanes);
  each_row([&](const PairRow& r) { out.push_back(r); });
  return out;
}

/// Where the contacts are in the batches, in the order of the list.
std::vector<std::uint32_t> PairContacts::lanes() const {
  std::vector<std::uint32_t> out;
  out.reserve(batch_count_ * batch_lanes);
  for (std::uint32_t at = 0; at < batch_count_ * batch_lanes; ++at) {
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

void PairContacts::restore(std::span<const PairRow> rows) {
  away_.clear();
  batch_count_ = (rows.size() + batch_lanes - 1) / batch_lanes;
  batches_.resize(batch_count_);
  for (std::uint32_t k = 0; k < batch_count_ * batch_lanes; ++k) {
    const std::uint32_t from = k < rows.size() ? k : k / batch_lanes * batch_lanes;
    put(rows[from], from, batches_[k / batch_lanes], k % batch_lanes);
  }
  carried_.clear();
  for (const PairRow& r : rows) {
    const std::array<float, 4> carried = carried_by(r);
    if (carried == nothing) continue;
    carried_.push_back(carried);
    away_.push_back({r.a, r.b});
  }
  listed_ = false;
  meeting_.count = rows.size();
}

BodyArrays PairContacts::arrays(Bodies& bodies) {
  return {bodies.moving.data()->velocity.data(), numbers_of(bodies.position), bodies.material.data(),
          bodies.carries.data(), numbers_of(bodies.before)};
}

PairTable PairContacts::table() { return {pairs_.lower(), pairs_.higher(), pairs_.size(), numbers_of(carried_)}; }

/// In pieces: what is close stays in the processor's cache, and room is made for those that meet, not for all.
void PairContacts::find(Bodies& bodies) {
  constexpr std::size_t piece = 4096;
  std::array<std::uint32_t, piece + batch_lanes> close;
  std::swap(meeting_, met_);
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
  batch_count_ = 0;
  make_room(meeting_.count / batch_lanes);
  const std::span<const std::uint32_t> all = meeting_.all();
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const ElementId group = group_of(bodies, all[begin]);
    while (end < all.size() && group_of(bodies, all[end]) == group) ++end;
    choose_colours(all.subspan(begin, end - begin), static_cast<std::uint32_t>(begin) + 1);
    start_group(bodies);
  }
}

/// For full batches, and as many more as those that are not full come to. Old ones go first: there are never two sets.
void PairContacts::make_room(std::size_t full) {
  if (batches_.capacity() >= full) return;
  std::vector<PairBatch>().swap(batches_);
  batches_.reserve(full + full / 4);
}

ElementId PairContacts::group_of(const Bodies& bodies, std::uint32_t pair) const {
  return bodies.roster.id(pairs_.lower()[pair]) / group_ids;
}

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
  std::size_t most = batch_count_ + coloured_[crowded].count;
  for (std::size_t c = 0; c < crowded; ++c) most += (coloured_[c].count + batch_lanes - 1) / batch_lanes;
  if (batches_.capacity() < most) batches_.reserve(most + most / 8);
  if (batches_.size() < most) batches_.resize(most);
  const auto fill = [&](std::span<const std::uint32_t> pairs) {
    kernels_.start({arrays(bodies), table(), rule_.numbers(), laws(), features(), pairs.data(), pairs.size(),
                    batches_.data() + batch_count_});
    batch_count_ += (pairs.size() + batch_lanes - 1) / batch_lanes;
  };
  for (std::size_t c = 0; c < crowded && coloured_[c].count > 0; ++c) fill(coloured_[c].all());
  for (const std::uint32_t& k : coloured_[crowded].all()) fill({&k, 1});
}

PairTask PairContacts::task(Bodies& bodies) {
  return {arrays(bodies), batches_.data(), batch_count_, rule_.numbers(), laws(), features()};
}

void PairContacts::relax(Bodies& bodies, bool last) {
  PairTask relaxing = task(bodies);
  if (last) {
    for (const std::uint32_t k : met_.all()) carried_[k] = nothing;
    relaxing.carried = numbers_of(carried_);
  }
  kernels_.relax(relaxing);
}

}  // namespace moraine::impulse
