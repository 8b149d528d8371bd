// SPDX-License-Identifier: Apache-2.0
// Impulses on their way from the contacts of one step to those of the next.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/impulse/pair_kernels.hpp"

namespace moraine::impulse {

/// Of the pairs of one group at a time, so that they stay in the processor's cache.
class CarriedImpulses {
 public:
  /// Begins with pairs of the list from `first` to `last`, which carry nothing.
  void begin(const PairTable& list, std::uint32_t first, std::uint32_t last);
  /// For old contacts that know the bodies of their pairs, but not the places in this list: finds these.
  void index();
  void find_places(std::span<PairBatch> batches) const {
    kernels_.place({table_, rows_, batches.data(), batches.size()});
  }
  /// What old contacts carry.
  void take(std::span<const PairBatch> batches) { kernels_.carry({batches.data(), batches.size(), pairs_}); }

  const PairCarried& pairs() const { return pairs_; }

 private:
  PairTable table_;
  PairCarried pairs_;
  PairRows rows_;
  std::vector<std::array<float, 4>> impulses_;
  std::vector<std::uint32_t> begin_;  ///< of the rows
  const PairKernels& kernels_ = pair_kernels();
};

}  // namespace moraine::impulse
