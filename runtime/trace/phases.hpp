// SPDX-License-Identifier: Apache-2.0
// What a rank is at, by the clock.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/trace/clock.hpp"
#include "runtime/trace/processor_time.hpp"
#include "runtime/trace/trace.hpp"

namespace moraine::runtime {

using PhaseSeconds = std::array<double, phase_count>;

/// Knows one phase at a time; called by the thread of worker 0. Cost: four looks at clocks per phase.
class Phases {
 public:
  explicit Phases(const RunClock& clock) : clock_(clock) {}

  /// The phase before ends.
  void enter(Phase phase) {
    leave();
    open_ = {.start = clock_.now(), .phase = phase};
    processor_ = processor_seconds();
  }
  void leave() {
    if (!open_) return;
    open_->end = clock_.now();
    open_->processor = static_cast<float>(processor_seconds() - processor_);
    seconds_[static_cast<std::size_t>(open_->phase)] += open_->seconds();
    since_taken_.push_back(*open_);
    open_.reset();
  }

  /// Of all phases that have ended.
  const PhaseSeconds& seconds() const { return seconds_; }
  /// Those that have ended since this was last called; epoch and rank are not filled in.
  std::vector<PhaseRecord> take() { return std::exchange(since_taken_, {}); }

 private:
  RunClock clock_;
  PhaseSeconds seconds_{};
  std::optional<PhaseRecord> open_;
  double processor_ = 0;
  std::vector<PhaseRecord> since_taken_;
};

}  // namespace moraine::runtime
