// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/batch_store.hpp"

#include <algorithm>
#include <utility>

namespace moraine::impulse {

void BatchStore::renew() {
  std::swap(blocks_, old_);
  std::swap(groups_, old_groups_);
  groups_.clear();
  count_ = taken_ = taken_groups_ = released_ = 0;
}

/// Old blocks that end up to there.
void BatchStore::release(std::size_t end) {
  for (; released_ < old_.size() && (released_ + 1) * per_block <= end; ++released_)
    free_.push_back(std::move(old_[released_]));
}

std::span<PairBatch> BatchStore::add(std::size_t wanted) {
  const std::size_t at = count_ % per_block;
  if (at == 0) {
    if (free_.empty()) free_.push_back(std::make_unique<Block>());
    blocks_.push_back(std::move(free_.back()));
    free_.pop_back();
  }
  const std::size_t count = std::min(wanted, per_block - at);
  count_ += count;
  return std::span(*blocks_.back()).subspan(at, count);
}

void BatchStore::end_group(ElementId group) {
  if (!groups_.empty() && groups_.back().id == group)
    groups_.back().end = count_;
  else
    groups_.push_back({group, count_});
}

}  // namespace moraine::impulse
