// SPDX-License-Identifier: Apache-2.0
// How far the run is, on standard error.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "physics/scene/scene.hpp"

namespace moraine {

/// What is known after a step.
struct ProgressSample {
  std::int64_t step = 0;  ///< done
  double time = 0;        ///< simulated [s]
  std::uint64_t ghosts = 0;
  double imbalance = 1;  ///< largest over mean busy time
};

/// One line of text: `done` is the number of steps made in `elapsed` seconds, less than sample.step after a restart.
std::string progress_line(const Scene& scene, const ProgressSample& sample, std::int64_t done, double elapsed);

/// On a terminal one line that is rewritten, at most five times a second; else a line per minute; nothing if quiet.
/// The scene must outlive it. Used by one thread.
class Progress {
 public:
  /// `first_step` is the number of steps done before this run.
  Progress(const Scene& scene, bool quiet, std::int64_t first_step = 0);
  /// Ends the line, so that a message that follows begins on its own.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(const ProgressSample& sample);
  /// Shows the last sample, however recent the one before, and ends the line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void show();

  const Scene& scene_;
  bool quiet_, terminal_;
  std::int64_t first_step_;
  Clock::time_point begin_ = Clock::now(), shown_ = begin_;
  ProgressSample sample_;
  bool fresh_ = false;  ///< the sample has not been shown
  bool open_ = false;   ///< the terminal's line has not been ended
};

}  // namespace moraine
