// SPDX-License-Identifier: Apache-2.0
// Where the time of a traced run went, who waited for whom, and what the run could not have been faster than.
#pragma once

#include <array>
#include <vector>

#include "runtime/profile/account.hpp"
#include "runtime/profile/chain.hpp"

namespace moraine::runtime {

/// Smallest, mean and largest of some numbers.
struct Range {
  double min = 0, mean = 0, max = 0;
};
Range range_of(std::span<const double> values);

struct StageProfile {
  double seconds = 0;
  std::int64_t tasks = 0;
  Range per_task;  ///< seconds
  Range per_rank;  ///< seconds
};

struct SubModelProfile {
  std::uint32_t id = 0;
  double seconds = 0;  ///< of its tasks
  double awaited = 0;  ///< seconds that workers waited while a task of it ran that had to be over before
  double on_path = 0;  ///< seconds of the critical path
  std::array<double, TaskRecord::max_counters> counters{};  ///< means over its tasks
  std::int64_t moves = 0;
};

/// Seconds that workers of `waiter` waited for tasks of `awaited`, or for their messages.
struct RankWait {
  int waiter = 0, awaited = 0;
  double tasks = 0, messages = 0;
};

/// The chain of tasks, messages and waits from when the ranks turn to the tasks of an epoch to the end of its last
/// task. The run cannot be faster unless the chain gets shorter.
struct CriticalPath {
  double tasks = 0, messages = 0, scheduling = 0;  ///< seconds; together: of all epochs' tasks
  double between = 0;                              ///< seconds: the rest of the run
  std::vector<double> stages;                      ///< seconds of tasks
  std::vector<double> ranks;
  std::int64_t hops = 0;          ///< from one rank to another
  std::vector<Segment> segments;  ///< ascending
};

struct Communication {
  double messages = 0, bytes = 0;                  ///< between sub-models
  double messages_between = 0, bytes_between = 0;  ///< between ranks
  std::int64_t pairs = 0;                          ///< of sub-models, one way, mean over epochs
  double on_their_way = 0;  ///< mean seconds from sending to being ready, of those that released a task
};

struct BalanceProfile {
  std::int64_t rounds = 0, carried_out = 0, moves = 0;
  double bytes = 0;
  double seconds = 0;        ///< that it took, on the slowest rank
  double forecast_gain = 0;  ///< seconds, of rounds that were carried out
  double gain = 0;  ///< measured: mean busy time times the fall of max/mean from the epoch before to that after, as
                    ///< many epochs as owners stayed
};

/// Busy seconds by rank, in each epoch.
struct EpochLoad {
  std::uint32_t epoch = 0;
  double start = 0, end = 0;
  std::vector<double> busy;

  double imbalance() const;
};

struct Profile {
  double elapsed = 0;  ///< seconds, of the traced epochs
  std::vector<Account> ranks;
  Account all;
  std::vector<StageProfile> stages;
  std::vector<SubModelProfile> sub_models;
  std::vector<RankWait> waits;  ///< the longest first
  CriticalPath path;
  Communication communication;
  BalanceProfile balance;
  std::vector<EpochLoad> epochs;

  double utilisation() const { return all.share(all.busy); }
  double imbalance() const;  ///< busiest rank / mean rank
  /// Places in sub_models of those with most of something, descending.
  std::vector<std::size_t> most(double SubModelProfile::*what, std::size_t count) const;
};

/// The trace must outlive it, its lists sorted. Errors: TraceError if it holds no task; std::out_of_range if it names
/// ranks, workers, stages or sub-models that are not there. Cost: O(tasks log tasks), and the length of every wait's
/// chain.
Profile profile_of(const Trace& trace);

}  // namespace moraine::runtime
