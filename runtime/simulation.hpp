// SPDX-License-Identifier: Apache-2.0
// The loop: epochs of rounds of stages of a model.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "runtime/schedule/executor.hpp"
#include "runtime/sub_model.hpp"
#include "runtime/transport/loopback.hpp"

namespace moraine::runtime {

/// None of these changes what is computed.
struct Options {
  int threads = 0;                   ///< 0: usable_cores()
  std::string scheduler = "hybrid";  ///< a name of schedulers()
  bool measured_cost = false;        ///< predict with the last epoch's times instead of counted work
  bool check_messages = false;       ///< destroy messages once read, to notice late readers
};

/// What the caller wants to do between epochs. Any may be empty.
struct Hooks {
  /// How many rounds from `next_round` on may pass before at_epoch_end must be called; at least 1.
  std::function<std::int64_t(std::int64_t next_round)> until_next_stop;
  /// All rounds before `next_round` are done and nothing runs.
  std::function<void(std::int64_t next_round)> at_epoch_end;
  TaskObserver* observer = nullptr;
};

class Simulation {
 public:
  /// `model` must outlive this. Errors: std::invalid_argument for an unknown scheduler or a negative number of threads.
  Simulation(Model& model, const Options& options, Hooks hooks = {});

  /// Runs rounds first_round .. first_round + rounds - 1. Errors: as Executor::run and build_step_graph; whatever the
  /// model and the hooks throw between epochs. After an error the model is in no defined state.
  void run(std::int64_t first_round, std::int64_t rounds);

  int threads() const { return executor_.workers(); }
  /// Of all rounds so far. What happens between epochs is not in it.
  const LoadRecord& load() const { return load_; }

 private:
  Epoch next_epoch(std::int64_t next_round, std::int64_t left);
  StepGraph predicted_graph();
  void run_epoch(const Epoch& epoch);
  void run_task(const StepGraph& graph, const Epoch& epoch, Task task);

  Model& model_;
  Options options_;
  Hooks hooks_;
  Executor executor_;
  LoopbackTransport transport_;
  LoadRecord load_;
  LoadRecord last_;  ///< the last epoch's
};

}  // namespace moraine::runtime
