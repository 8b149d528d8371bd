// SPDX-License-Identifier: Apache-2.0
#include "physics/native/verlet_list.hpp"

#include <algorithm>

namespace moraine::native {

void VerletList::build(const SizedGrid& grid, std::span<const Ball> balls, std::span<const std::uint8_t> passive,
                       double skin) {
  collect(grid, balls, passive, skin);
  sort_rows(balls.size());
}

/// Every ball looks for those of its own and of smaller classes.
void VerletList::collect(const SizedGrid& grid, std::span<const Ball> balls, std::span<const std::uint8_t> passive,
                         double skin) {
  found_.clear();
  for (std::size_t own = 0; own < grid.classes(); ++own)
    for (const std::uint32_t i : grid.members(own))
      for (std::size_t other = 0; other <= own; ++other) {
        const double reach = balls[i].radius + grid.largest_radius(other) + skin;
        grid.around(other, balls[i].centre, reach, [&](std::uint32_t j) {
          if ((other == own && j <= i) || (passive[i] && passive[j])) return;
          const double limit = balls[i].radius + balls[j].radius + skin;
          if ((balls[i].centre - balls[j].centre).squaredNorm() < limit * limit)
            found_.push_back({std::min(i, j), std::max(i, j)});
        });
      }
}

/// Counting sort by the lower number, then each short row by the higher one.
void VerletList::sort_rows(std::size_t balls) {
  row_end_.assign(balls + 1, 0);
  for (const auto& pair : found_) ++row_end_[pair[0] + 1];
  for (std::size_t i = 0; i < balls; ++i) row_end_[i + 1] += row_end_[i];
  lower_.resize(found_.size());
  higher_.resize(found_.size());
  for (const auto& [low, high] : found_) {
    const std::uint32_t at = row_end_[low]++;
    lower_[at] = low;
    higher_[at] = high;
  }
  for (std::size_t i = 0, begin = 0; i < balls; begin = row_end_[i++])
    std::sort(higher_.begin() + static_cast<std::ptrdiff_t>(begin), higher_.begin() + row_end_[i]);
}

std::size_t VerletList::find(std::uint32_t low, std::uint32_t high) const {
  const auto begin = higher_.begin() + (low == 0 ? 0 : row_end_[low - 1]), end = higher_.begin() + row_end_[low];
  const auto at = std::lower_bound(begin, end, high);
  return at != end && *at == high ? static_cast<std::size_t>(at - higher_.begin()) : size();
}

}  // namespace moraine::native
