// SPDX-License-Identifier: Apache-2.0
// What a trace says of the work itself, wherever it ran: tasks and their seconds, who sends whom how much, and what
// happens between epochs.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/balance/balancer.hpp"
#include "runtime/epoch.hpp"
#include "runtime/message_plan.hpp"
#include "runtime/trace/trace.hpp"

namespace moraine::runtime {

/// A message of every round, and its mean size.
struct SizedMessage {
  Message message;
  double bytes = 0;
};

/// Seconds between the rounds of two epochs, on the rank that others waited for.
struct Between {
  std::array<double, phase_count>
      phase{};  ///< `work`: from entering it to the first task, and from the last to its end
};

struct WorkEpoch {
  Epoch span;
  std::vector<SizedMessage> messages;  ///< ascending
  std::vector<double> cost;            ///< per node (sub-model * stages + stage): as schedulers predicted it
  std::vector<double> memory;          ///< per sub-model, bytes
  std::vector<double> seconds;         ///< of each node, round after round, the opening one first
  Owners owner;                        ///< in the traced run
  Between between;
  double moving = 0;  ///< seconds of between that moves were forecast to take
  double traced_seconds = 0;

  double seconds_of(std::size_t node, std::size_t nodes, std::int64_t round) const {
    return seconds[static_cast<std::size_t>(round) * nodes + node];
  }
};

/// What the traced machine spent on a task beside its work, means: what the operating system takes is in them. Medians
/// where cores were shared.
struct Overheads {
  double next = 0;  ///< seconds from a task being handed to a worker that has just ended one to its start
  double wake = 0;  ///< the same, to a worker that waited
  /// Seconds from sending a message to another rank to what it released being ready, where a worker waited for it: one
  /// that is at a task finds it later and loses nothing. 0: none was sent.
  double message = 0;
};

struct Workload {
  TraceSettings settings;
  std::size_t sub_models = 0;
  std::vector<WorkEpoch> epochs;
  Overheads overheads;
  double traced_makespan = 0;  ///< seconds of the epochs above, each from the first rank's begin to the last one's end

  std::size_t stages() const { return settings.stages.size(); }
  std::size_t nodes() const { return sub_models * stages(); }
  double seconds() const;  ///< of all tasks
  /// True if the traced run had more workers than cores. Then seconds are those that tasks had a core for, and what
  /// those who waited took from the cores.
  bool shares_cores() const;
};

/// Of at most `epochs` epochs. Errors: TraceError if the trace holds no complete epoch.
Workload workload_of(const Trace& trace, std::int64_t epochs = -1);

}  // namespace moraine::runtime
