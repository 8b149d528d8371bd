// SPDX-License-Identifier: Apache-2.0
// The contract of a transport: how messages get from one sub-model's task to another's.
#pragma once

#include "runtime/step_graph.hpp"
#include "runtime/sub_model.hpp"

namespace moraine::runtime {

/// Every message carries this, and its receiver checks it.
struct MessageHeader {
  int stage = Stage::none;
  SubModelId from = 0;
  SubModelId to = 0;
  std::int64_t round = -1;  ///< in its epoch
  bool operator==(const MessageHeader&) const = default;
};

/// Tasks of different sub-models may be open at once, from any thread; those of one sub-model may not. The caller
/// orders tasks as the step graph says; a transport needs no locks of its own between them.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Makes room for the messages of the model's present neighbours. What an earlier epoch left unread is dropped.
  /// Errors: std::logic_error as plan_messages().
  virtual void begin_epoch(Model& model) = 0;
  /// The letter box of (sub_model, stage) in a round of the epoch, valid until closed. A target that is sent nothing
  /// receives an empty message; so does every receiver of a message of the round before the opening one.
  virtual Port& open(SubModelId sub_model, int stage, std::int64_t round) = 0;
  /// The task is done: its messages may travel, and what it received may be overwritten.
  virtual void close(SubModelId sub_model) = 0;
};

}  // namespace moraine::runtime
