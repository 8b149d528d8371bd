// SPDX-License-Identifier: Apache-2.0
// Ranks inside one process, each used by a thread of its own. For runs without other ranks, and for tests.
#pragma once

#include <cstdint>

#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

struct LoopbackOptions {
  int ranks = 1;
  bool shuffled = false;   ///< parcels of different senders overtake each other, and some are held back for a while
  std::uint64_t seed = 0;  ///< of the shuffling
};

/// One transport per rank; all must live as long as any is used.
std::vector<std::unique_ptr<Transport>> make_loopback(const LoopbackOptions& options);

}  // namespace moraine::runtime
