// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/near_list.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/impulse/cells.hpp"
#include "physics/native/room.hpp"

namespace moraine::impulse {
namespace {

/// Along x neighbours lie one behind the other in memory, so cells are thin there.
constexpr float cells_per_reach[3] = {4, 1, 1};

std::size_t size_class(float radius, float smallest) { return static_cast<std::size_t>(std::ilogb(radius / smallest)); }

/// Few values, nearly in order.
void sort_short(std::uint32_t* begin, std::uint32_t* end) {
  for (std::uint32_t* next = begin + 1; next < end; ++next) {
    const std::uint32_t value = *next;
    std::uint32_t* at = next;
    for (; at > begin && at[-1] > value; --at) *at = at[-1];
    *at = value;
  }
}

}  // namespace

void NearList::build(std::span<const Vec> position, std::span<const std::uint8_t> passive, float skin) {
  skin_ = skin;
  size_ = 0;
  classify(position);
  tables_.clear();
  native::extend(row_, position.size() + batch_lanes);
  for (SizeClass& c : classes_) {
    c.sort(position, skin, row_);
    if (!c.members.empty()) tables_.push_back(c.table);
  }
  const NearTask task{skin_, tables_.data(), tables_.size()};
  for (std::uint32_t i = 0; i < position.size(); ++i)
    add_row(i, pair_kernels().near(task, position[i].data(), static_cast<std::int32_t>(i), row_.data()), passive);
}

void NearList::make_room(std::size_t pairs) {
  native::extend(lower_, pairs + batch_lanes);
  native::extend(higher_, pairs + batch_lanes);
}

void NearList::add_row(std::uint32_t body, std::size_t count, std::span<const std::uint8_t> passive) {
  make_room(size_ + count);
  const std::size_t begin = size_;
  for (std::size_t k = 0; k < count; ++k) {
    put(size_, {body, row_[k]});
    size_ += !(passive[body] && passive[row_[k]]);
  }
  sort_short(higher_.data() + begin, higher_.data() + size_);
}

/// Pairs of newcomers, ascending.
void NearList::find_near(std::span<const Vec> position, std::span<const std::uint8_t> passive,
                         std::span<const Place> newcomers) {
  found_.clear();
  native::extend(row_, position.size() + batch_lanes);
  const NearTask task{skin_, tables_.data(), tables_.size()};
  for (const Place i : newcomers) {
    const std::size_t count = pair_kernels().near(task, position[i].data(), -1, row_.data());
    for (std::size_t k = 0; k < count; ++k)
      if (!passive[row_[k]]) found_.push_back({std::min(i, row_[k]), std::max(i, row_[k])});
  }
  std::sort(found_.begin(), found_.end());
}

void NearList::follow(std::span<const Place> moved) {
  const std::size_t before = std::exchange(size_, 0);
  for (std::size_t k = 0; k < before; ++k) {
    const Pair now{moved[lower_[k]], moved[higher_[k]]};
    if (now[0] != nowhere && now[1] != nowhere) put(size_++, now);
  }
  for (SizeClass& c : classes_) c.follow(moved);
}

/// Backwards, so that the list makes room for those that are found.
void NearList::insert(std::span<const Vec> position, std::span<const std::uint8_t> passive,
                      std::span<const Place> newcomers) {
  find_near(position, passive, newcomers);
  make_room(size_ + found_.size());
  std::size_t old = size_, added = found_.size();
  size_ += added;
  for (std::size_t to = size_; added > 0; --to)
    put(to - 1, old > 0 && pair(old - 1) > found_[added - 1] ? pair(--old) : found_[--added]);
}

void NearList::classify(std::span<const Vec> position) {
  for (SizeClass& c : classes_) c.members.clear();
  float smallest = std::numeric_limits<float>::infinity(), largest = 0;
  for (const Vec& p : position) {
    smallest = std::min(smallest, p.w());
    largest = std::max(largest, p.w());
  }
  if (position.empty()) return;
  classes_.resize(std::max(classes_.size(), size_class(largest, smallest) + 1));
  const bool alike = largest < 2 * smallest;
  for (std::uint32_t i = 0; i < position.size(); ++i)
    native::append(classes_[alike ? 0 : size_class(position[i].w(), smallest)].members, i);
}

void NearList::SizeClass::sort(std::span<const Vec> position, float skin, std::span<std::uint32_t> cell) {
  if (members.empty()) {
    body.clear();
    return;
  }
  measure(position, skin);
  count(position, cell);
  fill(position, cell);
}

/// Those that left are nowhere near anything.
void NearList::SizeClass::follow(std::span<const Place> moved) {
  for (std::size_t k = 0; k + batch_lanes < body.size(); ++k) {
    if (body[k] == nowhere) continue;
    body[k] = moved[body[k]];
    if (body[k] == nowhere) x[k] = std::numeric_limits<float>::infinity();
  }
}

void NearList::SizeClass::measure(std::span<const Vec> position, float skin) {
  Extent extent;
  for (const std::uint32_t i : members) extent.add(position[i]);
  table.largest = std::max(extent.high.w(), 0.0F);  // none of them may be anywhere
  float size[3];
  for (int axis = 0; axis < 3; ++axis) size[axis] = (2 * table.largest + skin) / cells_per_reach[axis];
  table.cells = cells_in(extent, size, 8.0 * static_cast<double>(members.size()) + 27);
}

void NearList::SizeClass::count(std::span<const Vec> position, std::span<std::uint32_t> cell) {
  start.assign(cell_count(table.cells) + 1, 0);
  for (std::size_t k = 0; k < members.size(); ++k) {
    cell[k] = cell_of(table.cells, position[members[k]]);
    ++start[cell[k]];
  }
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
}

/// Backwards, from the ends of the cells to where they start.
void NearList::SizeClass::fill(std::span<const Vec> position, std::span<const std::uint32_t> cell) {
  for (std::vector<float>* v : {&x, &y, &z, &radius}) v->resize(members.size() + batch_lanes);
  body.resize(members.size() + batch_lanes);
  for (std::size_t k = members.size(); k-- > 0;) {
    const std::uint32_t to = --start[cell[k]];
    const Vec& p = position[members[k]];
    x[to] = p.x();
    y[to] = p.y();
    z[to] = p.z();
    radius[to] = p.w();
    body[to] = members[k];
  }
  table.start = start.data();
  table.x = x.data();
  table.y = y.data();
  table.z = z.data();
  table.radius = radius.data();
  table.body = body.data();
}

}  // namespace moraine::impulse
