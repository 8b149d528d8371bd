// SPDX-License-Identifier: Apache-2.0
// One clock for all ranks.
#pragma once

#include <chrono>

#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// Seconds since a moment that all ranks have agreed on.
class RunClock {
 public:
  /// This process alone: since now.
  RunClock() = default;
  /// Since rank 0 made its clock. Called by all ranks at once, while none sends. Every rank's offset to rank 0 is
  /// estimated as in Cristian (1989), Probabilistic clock synchronization, from the fastest of several messages there
  /// and back: it is wrong by half of that time at most. Drift is not followed. Cost: 16 messages there and back for
  /// every rank, one rank after another; up to 0.1 s of them where none is quick.
  explicit RunClock(Transport& transport);

  double now() const { return std::chrono::duration<double>(Clock::now() - origin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  void shift(double seconds);
  double offset_of(Transport& transport, int rank) const;
  void ask_all(Transport& transport) const;
  void answer(Transport& transport);

  Clock::time_point origin_ = Clock::now();
};

}  // namespace moraine::runtime
