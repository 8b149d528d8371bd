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

  /// Bodies have new places, in the same order; drops pairs of those that are nowhere. Calls kept(old, now) for the
  /// places of all other pairs, ascending. Cost: linear in pairs and bodies.
  template <class Kept>
  void follow(std::span<const Place> moved, Kept&& kept);
  /// Adds pairs of passive bodies that are new with those that are not passive and were there when the list was built.
  /// Calls shifted(old, now) for the places of pairs that move, descending. Cost: as follow().
  template <class Shifted>
  void insert(std::span<const Vec> position, std::span<const std::uint8_t> passive, std::span<const Place> newcomers,
              Shifted&& shifted);

  std::size_t size() const { return size_; }
  const std::uint32_t* lower() const { return lower_.data(); }
  const std::uint32_t* higher() const { return higher_.data(); }
  Pair pair(std::size_t k) const { return {lower_[k], higher_[k]}; }

 private:
  struct SizeClass {
    std::vector<std::uint32_t> members;  ///< ascending, when built
    std::vector<std::uint32_t> start, cell, body;
    std::vector<float> x, y, z, radius;  ///< in the order of cells; spare lanes at the end
    CellTable table;
    void sort(std::span<const Vec> position, float skin);
    void follow(std::span<const Place> moved);

   private:
    void measure(std::span<const Vec> position, float skin);
    void count(std::span<const Vec> position);
    void fill(std::span<const Vec> position);
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
  std::vector<std::uint32_t> row_;
  std::vector<Pair> found_;
  std::vector<std::uint32_t> lower_, higher_;  ///< the first size_ are in use
  std::size_t size_ = 0;
};

template <class Kept>
void NearList::follow(std::span<const Place> moved, Kept&& kept) {
  const std::size_t before = std::exchange(size_, 0);
  for (std::size_t k = 0; k < before; ++k) {
    const Pair now{moved[lower_[k]], moved[higher_[k]]};
    if (now[0] == nowhere || now[1] == nowhere) continue;
    put(size_, now);
    kept(k, size_++);
  }
  for (SizeClass& c : classes_) c.follow(moved);
}

template <class Shifted>
void NearList::insert(std::span<const Vec> position, std::span<const std::uint8_t> passive,
                      std::span<const Place> newcomers, Shifted&& shifted) {
  find_near(position, passive, newcomers);
  make_room(size_ + found_.size());
  std::size_t old = size_, added = found_.size();
  size_ += added;
  for (std::size_t to = size_; added > 0; --to) {
    if (old > 0 && pair(old - 1) > found_[added - 1]) {
      put(to - 1, pair(old - 1));
      shifted(--old, to - 1);
    } else {
      put(to - 1, found_[--added]);
    }
  }
}

}  // namespace moraine::impulse
