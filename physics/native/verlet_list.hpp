// SPDX-License-Identifier: Apache-2.0
// Pairs of balls that may touch before anything has moved half a skin (Verlet 1967), in an order that depends on the
// balls' numbers alone.
#pragma once

#include <span>
#include <vector>

#include "physics/native/sized_grid.hpp"

namespace moraine::native {

/// Rows of a compressed table: row i lists the partners j > i of ball i, ascending. Going through it from front to back
/// meets the partners of every ball, lower and higher ones, in ascending order.
class VerletList {
 public:
  /// Lists pairs with a gap below `skin`; of two passive balls none. `grid` holds the same balls.
  /// Cost: linear in balls and pairs.
  void build(const SizedGrid& grid, std::span<const Ball> balls, std::span<const std::uint8_t> passive, double skin);

  std::size_t size() const { return higher_.size(); }
  std::span<const std::uint32_t> lower() const { return lower_; }    ///< of every pair, ascending
  std::span<const std::uint32_t> higher() const { return higher_; }  ///< of every pair, ascending in a row
  /// The pair's place in the list, size() if it is not there. Cost: log of the row.
  std::size_t find(std::uint32_t low, std::uint32_t high) const;

 private:
  void collect(const SizedGrid& grid, std::span<const Ball> balls, std::span<const std::uint8_t> passive, double skin);
  void sort_rows(std::size_t balls);

  std::vector<std::uint32_t> lower_, higher_;
  std::vector<std::array<std::uint32_t, 2>> found_;
  std::vector<std::uint32_t> row_end_;
};

}  // namespace moraine::native
