// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/near_list.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::impulse {
namespace {

/// Along x neighbours lie one behind the other in memory, so cells are thin there.
constexpr float cells_per_reach[3] = {4, 1, 1};

int cell_along(const CellTable& t, int axis, float x) {
  const float c = (x - t.low[axis]) * t.inverse[axis];
  const int last = t.size[axis] - 1;
  return c > 0 ? (c < static_cast<float>(last) ? static_cast<int>(c) : last) : 0;
}

/// Cells of this size in a box; their number can be too large for an integer.
double cells_in(const Vec& extent, const float (&size)[3]) {
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) cells *= std::floor(static_cast<double>(extent[axis] / size[axis])) + 1;
  return cells;
}

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
  for (SizeClass& c : classes_) {
    c.sort(position, skin);
    if (!c.members.empty()) tables_.push_back(c.table);
  }
  row_.resize(position.size() + batch_lanes);
  const NearTask task{skin_, tables_.data(), tables_.size()};
  for (std::uint32_t i = 0; i < position.size(); ++i)
    add_row(i, pair_kernels().near(task, position[i].data(), static_cast<std::int32_t>(i), row_.data()), passive);
}

void NearList::make_room(std::size_t pairs) {
  if (lower_.size() >= pairs) return;
  lower_.resize(pairs + pairs / 4);
  higher_.resize(lower_.size());
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
  row_.resize(position.size() + batch_lanes);
  const NearTask task{skin_, tables_.data(), tables_.size()};
  for (const Place i : newcomers) {
    const std::size_t count = pair_kernels().near(task, position[i].data(), -1, row_.data());
    for (std::size_t k = 0; k < count; ++k)
      if (!passive[row_[k]]) found_.push_back({std::min(i, row_[k]), std::max(i, row_[k])});
  }
  std::sort(found_.begin(), found_.end());
}

void NearList::classify(std::span<const Vec> position) {
  for (SizeClass& c : classes_) c.members.clear();
  float smallest = std::numeric_limits<float>::infinity();
  for (const Vec& p : position) smallest = std::min(smallest, p.w());
  for (std::uint32_t i = 0; i < position.size(); ++i) {
    const auto size_class = static_cast<std::size_t>(std::ilogb(position[i].w() / smallest));
    if (size_class >= classes_.size()) classes_.resize(size_class + 1);
    classes_[size_class].members.push_back(i);
  }
}

void NearList::SizeClass::sort(std::span<const Vec> position, float skin) {
  if (members.empty()) {
    body.clear();
    return;
  }
  measure(position, skin);
  count(position);
  fill(position);
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
  const Vec far = Vec::Constant(std::numeric_limits<float>::max());
  Vec low = far, high = -far;
  for (const std::uint32_t i : members) {
    if (!position[i].allFinite()) continue;
    low = low.cwiseMin(position[i]);
    high = high.cwiseMax(position[i]);
  }
  if (high.w() < 0) low = high = Vec::Zero();  // none of them is anywhere
  table.largest = high.w();
  float size[3];
  for (int axis = 0; axis < 3; ++axis) size[axis] = (2 * table.largest + skin) / cells_per_reach[axis];
  const double most = 8.0 * static_cast<double>(members.size()) + 27;
  while (cells_in(high - low, size) > most)
    for (float& s : size) s *= 1.26F;
  for (int axis = 0; axis < 3; ++axis) {
    table.low[axis] = low[axis];
    table.inverse[axis] = 1 / size[axis];
    table.size[axis] = static_cast<int>((high[axis] - low[axis]) / size[axis]) + 1;
  }
}

void NearList::SizeClass::count(std::span<const Vec> position) {
  start.assign(static_cast<std::size_t>(table.size[0]) * table.size[1] * table.size[2] + 1, 0);
  cell.resize(members.size());
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Vec& p = position[members[k]];
    const std::size_t row =
        static_cast<std::size_t>(cell_along(table, 2, p.z())) * table.size[1] + cell_along(table, 1, p.y());
    cell[k] = static_cast<std::uint32_t>(row * table.size[0] + cell_along(table, 0, p.x()));
    ++start[cell[k] + 1];
  }
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
}

void NearList::SizeClass::fill(std::span<const Vec> position) {
  cursor.assign(start.begin(), start.end() - 1);
  for (std::vector<float>* v : {&x, &y, &z, &radius}) v->resize(members.size() + batch_lanes);
  body.resize(members.size() + batch_lanes);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::uint32_t to = cursor[cell[k]]++;
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
