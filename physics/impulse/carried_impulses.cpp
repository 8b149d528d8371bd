// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/carried_impulses.hpp"

#include <algorithm>
#include <numeric>

#include "physics/native/room.hpp"

namespace moraine::impulse {

void CarriedImpulses::begin(const PairTable& list, std::uint32_t first, std::uint32_t last) {
  table_ = list;
  const std::uint32_t count = last - first + 1;
  native::extend(impulses_, count + std::size_t{1});
  std::fill_n(impulses_.begin(), count, std::array<float, 4>{});
  pairs_ = {first, count, impulses_.front().data()};
}

void CarriedImpulses::index() {
  const std::uint32_t end = pairs_.first + pairs_.count, body = table_.lower[pairs_.first];
  const std::uint32_t bodies = table_.lower[end - 1] - body + 1;
  begin_.assign(bodies + std::size_t{1}, pairs_.first);
  for (std::uint32_t k = pairs_.first; k < end; ++k) begin_[table_.lower[k] - body + 1] = k + 1;
  std::inclusive_scan(begin_.begin(), begin_.end(), begin_.begin(), [](auto a, auto b) { return std::max(a, b); });
  rows_ = {body, bodies, begin_.data()};
}

}  // namespace moraine::impulse
