// SPDX-License-Identifier: Apache-2.0
// Pairs of bodies that may touch before anything has moved half a skin (Verlet 1967).
#pragma once

#include <span>
#include <vector>

#include "physics/impulse/bodies.hpp"
#include "physics/impulse/pair_kernels.hpp"

namespace moraine::impulse {

/// Pairs (lower, higher) in ascending order. Bodies of one size class, radii within a factor of two, are sorted into
/// cells; every body looks for those with a higher number in every class. Cost of build(): linear in bodies and pairs.
/// Buffers are reused.
class NearList {
 public:
  using Pair = std::array<std::uint32_t, 2>;

  /// Lists pairs with a gap below `skin`; of two passive bodies none. `position`: radius in the last lane.
  void build(std::span<const Vec> position, std::span<const std::uint8_t> passive, float skin);

  /// Bodies have new places, in the same order; drops pairs of those that are nowhere. Cost: linear in pairs and
  /// bodies.
  void follow(std::span<const Place> moved);
  /// Adds pairs of passive bodies that are new with those that are not passive and were there when the list was built.
  /// Cost: as follow().
  void insert(std::span<const Vec> position, std::span<const std::uint8_t> passive, std::span<const Place> newcomers);

  std::size_t size() const { return size_; }
  const std::uint32_t* lower() const { return lower_.data(); }
  const std::uint32_t* higher() const { return higher_.data(); }
  Pair pair(std::size_t k) const { return {lower_[k], higher_[k]}; }

 private:
  struct SizeClass {
    std::vector<std::uint32_t> members;  ///< ascending, when built
    std::vector<std::uint32_t> start, body;
    std::vector<float> x, y, z, radius;  ///< in the order of cells; spare lanes at the end
    CellTable table;
    void sort(std::span<const Vec> position, float skin, std::span<std::uint32_t> cell);
    void follow(std::span<const Place> moved);

   private:
    void measure(std::span<const Vec> position, float skin);
    void count(std::span<const Vec> position, std::span<std::uint32_t> cell);
    void fill(std::span<const Vec> position, std::span<const std::uint32_t> cell);
  };
  void classify(std::span<const Vec> position);
  void add_row(std::uint32_t body, std::size_t count, std::span<const std::uint8_t> passive);
  void find_near(std::span<const Vec> position, std::span<const std::uint8_t> passive,
                 std::span<const Place> newcomers);
  void make_room(std::size_t pairs);
  void put(std::size_t k, const Pair& pair) { lower_[k] = pair[0], higher_[k] = pair[1]; }

  std::vector<SizeClass> classes_;  ///< by rising size
  std::vector<CellTable> tables_;   ///< of those with members
  float skin_ = 0;
  std::vector<std::uint32_t> row_;  ///< near one body; before that the cells of bodies
  std::vector<Pair> found_;
  std::vector<std::uint32_t> lower_, higher_;  ///< the first size_ are in use, a spare batch follows
  std::size_t size_ = 0;
};

}  // namespace moraine::impulse
