// SPDX-License-Identifier: Apache-2.0
// Collects what ran on all ranks in one file.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "runtime/balance/rebalance.hpp"
#include "runtime/epoch.hpp"
#include "runtime/step_graph.hpp"
#include "runtime/trace/observer.hpp"
#include "runtime/trace/phases.hpp"
#include "runtime/trace/trace_file.hpp"
#include "runtime/transport/mail.hpp"

namespace moraine::runtime {

struct TraceOptions {
  std::filesystem::path file;  ///< empty: no trace; .json: Chrome trace JSON, else the compact form
  std::int64_t from = 0;       ///< step: epochs that do any of the steps from .. to - 1 are traced whole
  std::int64_t to = -1;        ///< -1: to the end
  std::int64_t every = 1;      ///< of these epochs, every so many
  std::string title;
  std::int64_t rounds_per_step = 1;
};

/// Tasks go to buffers, one per worker, that only grow. Between epochs, every some hundred rounds, all ranks pack their
/// lists and rank 0 writes them, so that memory stays bounded and a run that fails leaves what it has traced.
class Recorder final : public TaskObserver {
 public:
  /// Called by all ranks; `settings` are the same on all. Rank 0 opens the file.
  /// Errors: std::runtime_error if it cannot be written.
  Recorder(const TraceOptions& options, const TraceSettings& settings, Transport& transport, int workers);

  /// JSON of a run that failed is made here; if that is not possible, the compact form stays beside it, as .part.
  ~Recorder() override;

  /// Whether the coming epoch is traced. Called by all ranks.
  void begin_epoch(const Epoch& epoch);
  bool recording() const { return recording_; }

  /// What the task that a worker is running has carried; told before its task_done().
  struct Carried {
    Mail::Carried bytes;
    std::array<std::uint32_t, TaskRecord::max_counters> counters{};
  };
  void carried(int worker, const Carried& what) { at(worker).carried = what; }
  void task_done(const TaskRecord& record) override;

  /// The plan of the epoch, and what was sent by it.
  void plan(Model& model, const StepGraph& graph, const Epoch& epoch);
  void sent(const std::vector<Mail::Sent>& messages);
  void balanced(const BalanceRoundRecord& round, const std::vector<MoveRecord>& moves);
  /// The epoch is over. Called by all ranks.
  void end_epoch(std::vector<PhaseRecord> phases, const Epoch& epoch);
  /// Writes all that is known. Called by all ranks.
  void flush();
  /// The run has ended. Called by all ranks; more epochs may follow.
  void finish();

 private:
  struct alignas(64) Buffer {
    Carried carried;
    std::vector<TaskRecord> tasks;
  };
  Buffer& at(int worker) { return buffers_[static_cast<std::size_t>(worker)]; }
  bool in_window(const Epoch& epoch) const;
  void collect_tasks();
  std::filesystem::path raw_file() const;
  void make_json();

  TraceOptions options_;
  Transport& transport_;
  std::vector<Buffer> buffers_;
  TraceLists lists_;                   ///< of this rank, since the last flush
  std::optional<TraceWriter> writer_;  ///< on rank 0
  std::uint32_t epoch_ = 0;            ///< counted over the run
  std::int64_t in_window_ = 0;         ///< epochs so far
  std::int64_t unwritten_rounds_ = 0;
  bool recording_ = false;
  bool unconverted_ = false;  ///< the compact form holds more than the JSON
};

}  // namespace moraine::runtime
