// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/carried_impulses.hpp"

#include <algorithm>

#include "physics/native/room.hpp"

namespace moraine::impulse {

void CarriedImpulses::begin(const NearList& list, std::uint32_t first, std::uint32_t last) {
  list_ = &list;
  const std::uint32_t count = last - first + 1;
  native::extend(impulses_, count + std::size_t{1});
  std::fill_n(impulses_.begin(), count, std::array<float, 4>{});
  pairs_ = {first, count, impulses_.front().data()};
}

void CarriedImpulses::index() {
  rows_.clear();
  const std::uint32_t* lower = list_->lower();
  const std::uint32_t end = pairs_.first + pairs_.count;
  for (std::uint32_t k = pairs_.first; k < end; ++k)
    while (rows_.size() + lower[pairs_.first] <= lower[k]) rows_.push_back(k);
  rows_.push_back(end);
}

void CarriedImpulses::find_places(std::span<PairBatch> batches) const {
  for (PairBatch& batch : batches)
    for (std::size_t lane = 0; lane < batch_lanes; ++lane) batch.pair[lane] = place(batch.a[lane], batch.b[lane]);
}

/// Nowhere if there is no such pair.
std::uint32_t CarriedImpulses::place(std::uint32_t a, std::uint32_t b) const {
  const std::size_t row = a - list_->lower()[pairs_.first];
  if (row + 1 >= rows_.size()) return nowhere;
  std::uint32_t k = rows_[row];
  while (k < rows_[row + 1] && list_->higher()[k] < b) ++k;
  return k < rows_[row + 1] && list_->higher()[k] == b ? k : nowhere;
}

}  // namespace moraine::impulse
