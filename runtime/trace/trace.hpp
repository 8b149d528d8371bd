// SPDX-License-Identifier: Apache-2.0
// What ran where and when, as plain data. Times are seconds on the clock of rank 0 since the start of the run.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace moraine::runtime {

/// What made a task ready.
enum class Release : std::uint8_t {
  start,   ///< nothing: it could run from the start of its epoch
  task,    ///< a task of the same rank
  message  ///< of a task of another rank
};

/// A task that ended well.
struct TaskRecord {
  static constexpr std::size_t max_counters = 4;

  double start = 0;
  double end = 0;
  double sent = 0;            ///< when the message that released it left; unless released by one: as ready
  double ready = 0;           ///< when its last predecessor ended or arrived
  double handed = 0;          ///< when the scheduler gave it to its worker; ready <= handed <= start
  std::int64_t round = 0;     ///< counted over the run; an opening round has the number of the next one
  std::int32_t in_epoch = 0;  ///< round in its epoch; 0: the opening one
  std::uint32_t epoch = 0;    ///< counted over the run
  std::uint32_t sub_model = 0;
  std::uint32_t released_by = 0;  ///< the sub-model of the task that released this one, if any did
  std::uint32_t bytes_sent = 0;   ///< to all its targets
  std::uint32_t bytes_received = 0;
  std::array<std::uint32_t, max_counters> counters{};  ///< as named by TraceSettings::counters
  std::int32_t rank = 0;
  std::int16_t worker = 0;
  std::int16_t stage = 0;
  std::int16_t released_stage = 0;
  Release release = Release::start;
  bool released_before = false;  ///< the releasing task was of the round before
  float processor = 0;           ///< seconds that its thread had a core; all of them where that is not measured

  double seconds() const { return end - start; }
};

/// What a rank does, one after the other in every epoch. Only in `work` tasks run.
enum class Phase : std::int32_t { settle, balance, checkpoint, plan, work, agree, output };
constexpr std::array phase_names{"settle", "balance", "checkpoint", "plan", "work", "agree", "output"};
constexpr std::size_t phase_count = phase_names.size();

/// A phase of an epoch on a rank. settle: neighbours; plan: step graph and letter boxes; agree: ranks wait for the last
/// and learn of failures; output: whatever the caller does between epochs.
struct PhaseRecord {
  double start = 0;
  double end = 0;
  std::uint32_t epoch = 0;
  std::int32_t rank = 0;
  Phase phase = Phase::work;
  float processor = 0;  ///< seconds that the thread of worker 0 had a core

  double seconds() const { return end - start; }
};

/// An epoch: `rounds` rounds after the opening one, all with the same neighbours and owners.
struct EpochRecord {
  std::int64_t first_round = 0;
  std::int64_t rounds = 0;
  std::uint32_t epoch = 0;
  std::uint32_t unused = 0;
};

/// Who owned a sub-model in an epoch.
struct OwnerRecord {
  std::uint32_t epoch = 0;
  std::uint32_t sub_model = 0;
  std::int32_t rank = 0;
  std::uint32_t unused = 0;
  double memory = 0;  ///< bytes, about
};

/// What the scheduler took a task to cost, in any unit.
struct CostRecord {
  std::uint32_t epoch = 0;
  std::uint32_t sub_model = 0;
  std::int32_t stage = 0;
  std::uint32_t unused = 0;
  double cost = 0;
};

/// A message that `from` sends `to` in every round of an epoch. It is read in the same round if sent_in < read_in, else
/// in the next one.
struct MessageRecord {
  std::uint32_t epoch = 0;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::int16_t sent_in = 0;  ///< stage
  std::int16_t read_in = 0;  ///< stage
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;  ///< of all of them
};

/// Owners were looked at before an epoch.
struct BalanceRoundRecord {
  std::int64_t round = 0;  ///< the first under the new owners
  std::uint32_t epoch = 0;
  std::uint32_t carried_out = 0;
  double imbalance = 1;        ///< max/mean busy seconds of ranks since the balance before
  double forecast_before = 1;  ///< max/mean of predicted load with the old owners
  double forecast_after = 1;   ///< with those proposed
  double gain_seconds = 0;     ///< forecast
  double cost_seconds = 0;     ///< forecast
  std::int64_t moves = 0;      ///< proposed
  double moved_bytes = 0;      ///< by all ranks
  double seconds = 0;          ///< on this rank: collecting, planning, moving
};

/// A sub-model changed ranks before an epoch.
struct MoveRecord {
  std::uint32_t epoch = 0;
  std::uint32_t sub_model = 0;
  std::int32_t from = 0;
  std::int32_t to = 0;
};

/// How the run was set up.
struct TraceSettings {
  std::string title;
  std::string scheduler, balancer, predictor;
  std::int64_t balance_every = 1;  ///< rounds
  bool balance_measured = false;
  std::int64_t sub_models = 0;
  std::int64_t rounds_per_step = 1;
  std::vector<int> threads;           ///< per rank
  std::vector<double> cores;          ///< per rank: its share of those it may use
  std::vector<std::string> stages;    ///< names
  std::vector<int> receives;          ///< per stage: the stage whose messages it reads, or -1
  std::vector<std::string> counters;  ///< names, at most TaskRecord::max_counters
  std::int64_t from = 0, to = -1;     ///< steps traced: from .. to - 1; -1: to the end
  std::int64_t every = 1;             ///< of the epochs in there, every so many

  int ranks() const { return static_cast<int>(threads.size()); }
  int workers() const { return std::accumulate(threads.begin(), threads.end(), 0); }
  double all_cores() const { return std::accumulate(cores.begin(), cores.end(), 0.0); }
};

/// All records of some epochs. Lists of different ranks stand one behind the other.
struct TraceLists {
  std::vector<TaskRecord> tasks;
  std::vector<PhaseRecord> phases;
  std::vector<EpochRecord> epochs;
  std::vector<OwnerRecord> owners;
  std::vector<CostRecord> costs;
  std::vector<MessageRecord> messages;
  std::vector<BalanceRoundRecord> balance;
  std::vector<MoveRecord> moves;
};

struct Trace {
  TraceSettings settings;
  TraceLists lists;
  bool complete = true;  ///< false: the run was cut short
};

}  // namespace moraine::runtime
