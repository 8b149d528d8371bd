// SPDX-License-Identifier: Apache-2.0
// Why a worker waited.
#pragma once

#include <algorithm>

#include "runtime/trace/trace.hpp"

namespace moraine::runtime {

/// What made a task ready, and when.
struct Released {
  Release by = Release::start;
  bool before = false;  ///< by a task of the round before
  std::int16_t stage = 0;
  std::uint32_t sub_model = 0;
  double sent = 0;   ///< when the message left, else as ready
  double ready = 0;  ///< seconds on the run's clock
};

/// Seconds of one worker's waiting, by cause.
struct Wait {
  double within = 0;    ///< for tasks of its own rank
  double among = 0;     ///< for tasks of other ranks
  double messages = 0;  ///< for messages on their way
  double held = 0;      ///< there was a task, the scheduler gave it later
  double overhead = 0;  ///< there was a task in its hands: scheduler, locks, waking up

  double total() const { return within + among + messages + held + overhead; }
  Wait& operator+=(const Wait& other) {
    within += other.within;
    among += other.among;
    messages += other.messages;
    held += other.held;
    overhead += other.overhead;
    return *this;
  }
};

/// From `idle` until a task's start, told apart by what the task itself waited for.
inline Wait wait_before(double idle, const Released& released, double handed, double start) {
  const double ready = std::clamp(released.ready, idle, std::max(idle, start));
  const double given = std::clamp(handed, ready, std::max(ready, start));
  Wait wait{.held = given - ready, .overhead = std::max(0.0, start - given)};
  if (released.by == Release::message) {
    wait.among = std::clamp(released.sent, idle, ready) - idle;
    wait.messages = ready - idle - wait.among;
  } else {
    wait.within = ready - idle;
  }
  return wait;
}

/// From `idle` until the end of its epoch's work: for the last task of the rank at `last`, then for all to notice.
inline Wait wait_after(double idle, double last, double end) {
  const double until = std::clamp(last, idle, std::max(idle, end));
  return {.within = until - idle, .overhead = std::max(0.0, end - until)};
}

}  // namespace moraine::runtime
