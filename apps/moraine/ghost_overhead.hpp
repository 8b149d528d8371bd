// SPDX-License-Identifier: Apache-2.0
// What sub-models do for ghosts, by what their tasks counted.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "runtime/trace/trace.hpp"

namespace moraine::app {

struct GhostOverhead {
  double elements = 0, ghosts = 0;  ///< of the whole model
  double share = 0;                 ///< of the busy time: ghosts among the bodies of each sub-model, by its time
  std::vector<double> of{};         ///< the same of each sub-model

  /// What a finer cut is told. A model in one piece has no ghosts yet: a layer of its elements is taken.
  std::vector<double> halo() const;
};

using Counters = std::array<double, runtime::TaskRecord::max_counters>;

/// `counters` and `seconds` of each sub-model; counters named "elements" and "ghosts" are looked at, if there are such.
GhostOverhead ghost_overhead(const runtime::TraceSettings& settings, std::span<const Counters> counters,
                             std::span<const double> seconds);

}  // namespace moraine::app
