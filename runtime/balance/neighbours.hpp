// SPDX-License-Identifier: Apache-2.0
// Who each sub-model exchanges messages with.
#pragma once

#include <span>
#include <vector>

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

struct Neighbour {
  SubModelId id = 0;
  double bytes = 0;  ///< per round, both ways
};

/// Lists of neighbours, ascending.
class Neighbours {
 public:
  explicit Neighbours(const BalanceProblem& problem);
  std::span<const Neighbour> of(SubModelId s) const {
    return std::span(list_).subspan(first_[s], first_[s + 1] - first_[s]);
  }
  /// Bytes per round that `s` exchanges with sub-models of `rank`.
  double bytes_with(const Owners& owners, SubModelId s, int rank) const;

 private:
  std::vector<std::size_t> first_;
  std::vector<Neighbour> list_;
};

}  // namespace moraine::runtime
