// SPDX-License-Identifier: Apache-2.0
// The loop: epochs of rounds of stages of a model, on all ranks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "runtime/balance/rebalance.hpp"
#include "runtime/migrate/checkpoint.hpp"
#include "runtime/schedule/executor.hpp"
#include "runtime/sub_model.hpp"
#include "runtime/trace/phases.hpp"
#include "runtime/trace/recorder.hpp"
#include "runtime/transport/mail.hpp"

namespace moraine::runtime {

/// None of these changes what is computed.
struct Options {
  int threads = 0;                   ///< of this rank; 0: its share of usable_cores()
  std::string scheduler = "hybrid";  ///< a name of schedulers()
  bool measured_cost = false;        ///< predict with the last epoch's times instead of counted work
  bool processor_time = true;        ///< on several ranks loads are processor time, for 1 us per task; else wall time
  bool check_messages = false;       ///< destroy messages once read, to notice late readers
  Transport* transport = nullptr;    ///< must outlive the simulation; none: this process is alone
  BalanceOptions balance = {};
  CheckpointOptions checkpoint = {};
  TraceOptions trace = {};
  /// The exit status that goes with what a task threw.
  std::function<int(const std::exception_ptr&)> status_of = [](const std::exception_ptr&) { return 1; };
};

/// What the caller wants to do between epochs. Any may be empty. Called on all ranks.
struct Hooks {
  /// How many rounds from `next_round` on may pass before at_epoch_end must be called; at least 1.
  std::function<std::int64_t(std::int64_t next_round)> until_next_stop;
  /// All rounds before `next_round` are done and nothing runs.
  std::function<void(std::int64_t next_round)> at_epoch_end;
};

class Simulation {
 public:
  /// `model` must outlive this, and is placed on the transport's ranks.
  /// Errors: std::invalid_argument for unknown names or a negative number of threads.
  Simulation(Model& model, const Options& options, Hooks hooks = {});

  /// Continues from a checkpoint in `folder` instead of from the model as it is. Returns the first round to run.
  /// Errors: CheckpointError.
  std::int64_t restore(const std::filesystem::path& folder);

  /// Runs rounds first_round .. first_round + rounds - 1. Errors: RunError, the same on every rank; as
  /// build_step_graph; whatever the model and the hooks throw between epochs. After an error the model is in no defined
  /// state.
  void run(std::int64_t first_round, std::int64_t rounds);

  /// How the run is set up. Collective.
  TraceSettings settings() const;
  Model& model() { return model_; }
  int threads() const { return executor_.workers(); }
  Transport& transport() const { return transport_; }
  /// Of this rank, of all rounds so far. What happens between epochs is not in it.
  const LoadRecord& load() const { return load_; }
  /// Of this rank: what its time went to, in run().
  const PhaseSeconds& phase_seconds() const { return phases_.seconds(); }
  const Rebalance& balance() const { return balance_; }
  /// Of this rank.
  const Mail::Totals& messages() const { return mail_.totals(); }
  /// From here in the last epoch.
  std::vector<Mail::Sent> last_sent() const { return mail_.sent(); }
  std::int64_t rounds() const { return rounds_; }

 private:
  struct NextEpoch {
    Epoch epoch;
    bool fresh = true;
  };
  NextEpoch next_epoch(std::int64_t next_round, std::int64_t left);
  void settle(std::int64_t next_round);
  StepGraph predicted_graph();
  void run_epoch(const Epoch& epoch);
  void end_epoch(const Epoch& epoch);
  std::optional<RunError> attempt(const StepGraph& graph, const Epoch& epoch);
  void run_task(const StepGraph& graph, const Epoch& epoch, Task task, int worker);
  void note_task(SubModelId id, int worker, const Mail::Carried& carried);
  void tell_others();

  Model& model_;
  Options options_;
  Hooks hooks_;
  Transport& transport_;
  RunClock clock_;
  Phases phases_;
  Executor executor_;
  Mail mail_;
  Rebalance balance_;
  Checkpoints checkpoints_;
  std::int64_t rounds_ = 0;
  LoadRecord load_;
  LoadRecord last_;  ///< the last epoch's
  std::optional<Recorder> recorder_;
};

/// Cores that each of the ranks on this machine may use without taking turns; at least 1. Collective.
int threads_for(Transport& transport);

}  // namespace moraine::runtime
