// SPDX-License-Identifier: Apache-2.0
// The batches of a step, and those of the step before while the new ones are made.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "physics/impulse/pair_kernels.hpp"
#include "physics/types.hpp"

namespace moraine::impulse {

/// Batches in the order in which they are solved, in groups with rising ids, in blocks. Old groups are taken one by
/// one; their blocks hold the next new ones, while they are still in the processor's cache. So there are never two
/// sets.
class BatchStore {
 public:
  std::size_t size() const { return count_; }
  PairBatch& operator[](std::size_t k) { return (*blocks_[k / per_block])[k % per_block]; }
  const PairBatch& operator[](std::size_t k) const { return (*blocks_[k / per_block])[k % per_block]; }
  /// In pieces that lie one behind the other.
  template <class Visit>
  void each(Visit&& visit) {
    visit_range(blocks_, 0, count_, visit);
  }

  /// All batches are old; new ones begin.
  void renew();
  /// Forgets old groups up to this one, after a look at the batches of this one.
  template <class Visit>
  void take(ElementId group, Visit&& visit);
  void take_rest() { release(~std::size_t{0}), old_.clear(); }
  /// New batches, at least one and at most so many.
  std::span<PairBatch> add(std::size_t wanted);
  /// Those added since the last call are of this group.
  void end_group(ElementId group);

 private:
  static constexpr std::size_t per_block = 32;
  using Block = std::array<PairBatch, per_block>;
  using Blocks = std::vector<std::unique_ptr<Block>>;
  struct Group {
    ElementId id = 0;
    std::size_t end = 0;  ///< of its batches
  };
  template <class Visit>
  static void visit_range(Blocks& blocks, std::size_t begin, std::size_t end, Visit& visit);
  void release(std::size_t end);

  Blocks blocks_, old_, free_;
  std::size_t count_ = 0;
  std::vector<Group> groups_, old_groups_;
  std::size_t taken_ = 0, taken_groups_ = 0, released_ = 0;  ///< of the old batches, groups and blocks
};

template <class Visit>
void BatchStore::visit_range(Blocks& blocks, std::size_t begin, std::size_t end, Visit& visit) {
  while (begin < end) {
    const std::size_t at = begin % per_block, count = std::min(end - begin, per_block - at);
    visit(std::span(*blocks[begin / per_block]).subspan(at, count));
    begin += count;
  }
}

template <class Visit>
void BatchStore::take(ElementId group, Visit&& visit) {
  for (; taken_groups_ < old_groups_.size() && old_groups_[taken_groups_].id <= group; ++taken_groups_) {
    const Group& old = old_groups_[taken_groups_];
    if (old.id == group) visit_range(old_, taken_, old.end, visit);
    taken_ = old.end;
  }
  release(taken_);
}

}  // namespace moraine::impulse
