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
  double traced_seconds = 0;

  double seconds_of(std::size_t node, std::size_t nodes, std::int64_t round) const {
    return seconds[static_cast<std::size_t>(round) * nodes + node];
  }
};

/// What the traced machine spent on a task beside its work, means: what the operating system takes is in them.
struct Overheads {
  double next = 0;     ///< seconds from the end of a task to the start of the next on the same worker, if one is ready
  double wake = 0;     ///< seconds from a task being ready to its start on a worker that waited for it
  double message = 0;  ///< seconds from sending a message to another rank to what it released being ready; 0: none sent
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
};

/// Of at most `epochs` epochs. Errors: TraceError if the trace holds no complete epoch.
Workload workload_of(const Trace& trace, std::int64_t epochs = -1);

/// The messages of an epoch of `copies` copies of the model in a row. Copy c has the sub-models c * n ... c * n + n
/// - 1. The last f of a copy are joined to the first f of the next one, in order, with the messages of a typical pair
/// of neighbours. f is the side of a cut in as many dimensions as the number of neighbours suggests: 1 for up to 2 of
/// them on average, the square root of n for up to 8, else n^(2/3). No neighbours: no joins.
std::vector<SizedMessage> side_by_side(const WorkEpoch& epoch, std::size_t sub_models, std::size_t copies);

}  // namespace moraine::runtime
