// SPDX-License-Identifier: Apache-2.0
// Impulses on their way from the contacts of one step to those of the next.
#pragma once

#include <span>
#include <vector>

#include "physics/impulse/near_list.hpp"
#include "physics/impulse/pair_kernels.hpp"

namespace moraine::impulse {

/// Of the pairs of one group at a time, so that they stay in the processor's cache.
class CarriedImpulses {
 public:
  /// Begins with pairs of the list from `first` to `last`, which carry nothing.
  void begin(const NearList& list, std::uint32_t first, std::uint32_t last);
  /// Old contacts that know the bodies of their pairs, but not the places in this list: finds these.
  void index();
  void find_places(std::span<PairBatch> batches) const;
  /// What old contacts carry.
  void take(std::span<const PairBatch> batches) { kernels_.carry({batches.data(), batches.size(), pairs_}); }

  const PairCarried& pairs() const { return pairs_; }

 private:
  std::uint32_t place(std::uint32_t a, std::uint32_t b) const;

  const NearList* list_ = nullptr;
  PairCarried pairs_;
  std::vector<std::array<float, 4>> impulses_;
  std::vector<std::uint32_t> rows_;  ///< by lower body from the first one's: where its pairs begin
  const PairKernels& kernels_ = pair_kernels();
};

}  // namespace moraine::impulse
