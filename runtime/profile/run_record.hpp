// SPDX-License-Identifier: Apache-2.0
// What is known of a run that was not traced, and the work that stands in for it in replays.
#pragma once

#include <array>
#include <vector>

#include "runtime/profile/account.hpp"
#include "runtime/replay/workload.hpp"
#include "runtime/simulation.hpp"

namespace moraine::runtime {

/// Complete on rank 0. Sub-models, owners and messages are those of the last epoch.
struct RunRecord {
  using Counters = std::array<std::uint32_t, TaskRecord::max_counters>;

  TraceSettings settings{};
  std::vector<RankLoad> ranks{};
  std::vector<SizedMessage> messages{};
  Owners owner{};
  std::vector<double> cost{};        ///< per node, counted
  std::vector<double> memory{};      ///< per sub-model, bytes
  std::vector<Counters> counters{};  ///< per sub-model
  double rounds = 0, epochs = 0;
  double elapsed = 0;  ///< seconds, of the slowest rank

  /// Processor time of each sub-model's tasks on all ranks.
  std::vector<double> seconds() const;
};

/// Collective.
RunRecord record_of(Simulation& simulation);

/// Epochs that are all alike: every task takes its node's mean, what happens between epochs its mean, and idle hands
/// the mean time from a task being handed out to its start. There are four epochs at least if the run had as many, and
/// no more rounds and epochs than keep replays short: about 20,000 tasks. Errors: std::invalid_argument if nothing ran.
Workload typical_workload(const RunRecord& run);

}  // namespace moraine::runtime
