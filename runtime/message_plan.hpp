// SPDX-License-Identifier: Apache-2.0
// Who sends to whom in every round of an epoch.
#pragma once

#include <compare>
#include <vector>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

struct Message {
  SubModelId from = 0;
  int sent_in = 0;  ///< stage
  SubModelId to = 0;
  int read_in = 0;  ///< stage

  /// Whether it is read in the round after the one it is sent in.
  bool next_round() const { return sent_in >= read_in; }
  auto operator<=>(const Message&) const = default;
};

/// All messages of a round that sub-models held here send or receive, ascending by (from, sent_in, to).
/// Errors: std::logic_error if sources and targets of two sub-models held here do not mirror each other (names the
/// pair), are not ascending, or if a stage has two receivers. Cost: sorts the messages.
std::vector<Message> plan_messages(Model& model);

}  // namespace moraine::runtime
