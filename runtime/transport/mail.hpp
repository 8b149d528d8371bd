// SPDX-License-Identifier: Apache-2.0
// The messages of an epoch: in memory between sub-models of this process, by parcel to and from those of other ranks.
#pragma once

#include <array>
#include <deque>
#include <mutex>
#include <vector>

#include "runtime/epoch.hpp"
#include "runtime/message_plan.hpp"
#include "runtime/step_graph.hpp"
#include "runtime/trace/clock.hpp"
#include "runtime/transport/envelope.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// A message from another rank is there for a task.
struct Arrival {
  Task task;
  SubModelId from = 0;
  int sent_in = 0;     ///< stage
  double sent_at = 0;  ///< on the run's clock
};

/// Two buffers per (stage, from, to), used by turns. Buffers are kept: once they have grown, nothing is allocated for
/// messages within the process. Tasks of different sub-models may be open at once, from any thread; those of one
/// sub-model may not. The caller orders tasks as the step graph says.
class Mail {
 public:
  /// With `poison` a message is destroyed when its receiver closes, so that reading it late is noticed. `clock`: what
  /// messages to other ranks are dated by. `transport` must outlive this.
  explicit Mail(Transport& transport = alone(), bool poison = false, RunClock clock = {});
  ~Mail();

  /// Makes room for the messages of the model's present neighbours. What an earlier epoch left unread is dropped.
  /// Errors: std::logic_error as plan_messages().
  void begin_epoch(Model& model, const Epoch& epoch);
  /// The letter box of (sub_model, stage) in a round of the epoch, valid until closed. A target that is sent nothing
  /// receives an empty message; so does every receiver of a message of the round before the opening one.
  Port& open(SubModelId sub_model, int stage, std::int64_t round);
  /// Bytes of a task's messages, without envelopes.
  struct Carried {
    std::uint64_t sent = 0, received = 0;
  };
  /// The task is done: its messages travel, and what it received may be overwritten.
  Carried close(SubModelId sub_model);

  /// Appends the tasks for which messages have come from other ranks, as nodes of `graph`. One thread at a time.
  /// Errors: std::runtime_error for a parcel that is damaged or of another version, std::logic_error for one that
  /// nobody expects; FailedElsewhere if it says that another rank has failed.
  void poll(const StepGraph& graph, std::vector<Arrival>& arrived);

  /// What was sent along each message of the plan since begin_epoch().
  struct Sent {
    Message message;
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;
  };
  std::vector<Sent> sent() const;

  /// Over all epochs, sent from here.
  struct Totals {
    double messages = 0, bytes = 0;
    double between_ranks = 0;  ///< messages to other ranks
    double pairs = 0;          ///< of sub-models, one way, times epochs
    double epochs = 0;
  };
  const Totals& totals() const { return totals_; }
  /// Called at the end of an epoch.
  void close_epoch();

 private:
  class Box;
  struct alignas(64) Slot {
    Envelope envelope;
    bool sent = false;
    double sent_at = 0;
    std::vector<std::byte> bytes;
  };
  /// One message of the plan.
  struct Line {
    Message message;
    int to_rank = 0;
    bool from_here = true;
    std::array<Slot, 2> slots;
    std::uint64_t messages = 0, bytes = 0;
  };
  /// Arrivals at a line from elsewhere. A slot is filled again only after it has been read; the nothing that comes
  /// before the opening round, too, must have been read first.
  struct Arrivals {
    std::array<bool, 2> unread{};
    std::deque<Slot> waiting;  ///< in the order of rounds
  };

  std::size_t node(SubModelId sub_model, int stage) const;
  void lay_out(Model& model);
  std::uint64_t post(Line& line, std::int64_t round);
  void take_in(const Parcel& parcel);
  std::size_t line_of(const Envelope& envelope) const;
  void deliver(std::size_t line);
  void was_read(std::size_t line, std::int64_t sent_round);

  Transport& transport_;
  bool poison_;
  RunClock clock_;
  std::int64_t epoch_ = 0;  ///< counted
  std::int64_t rounds_ = 0;
  std::size_t stages_ = 0;
  std::vector<int> receives_;              ///< per stage
  std::vector<Line> lines_;                ///< in the order of plan_messages()
  std::vector<std::size_t> first_out_;     ///< per node, into out_ and to_
  std::vector<std::size_t> out_;           ///< lines by sending node, ascending by receiver
  std::vector<SubModelId> to_;             ///< per entry of out_
  std::vector<std::size_t> first_in_;      ///< per node, into in_ and from_
  std::vector<std::size_t> in_;            ///< lines by receiving node, ascending by sender
  std::vector<SubModelId> from_;           ///< per entry of in_
  std::vector<std::unique_ptr<Box>> box_;  ///< per sub-model

  std::mutex mutex_;                ///< guards what follows
  std::vector<Arrivals> arrivals_;  ///< per line
  struct Ready {
    Message message;
    std::int64_t round;  ///< in which it is read
    double sent_at;
  };
  std::vector<Ready> ready_;  ///< arrived and not yet told
  Totals totals_;
};

}  // namespace moraine::runtime
