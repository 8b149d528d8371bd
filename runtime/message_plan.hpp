// SPDX-License-Identifier: Apache-2.0
// Who sends to whom in every round of an epoch.
#pragma once

#include <vector>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

struct Message {
  SubModelId from = 0;
  int sent_in = 0;  ///< stage
  SubModelId to = 0;
  int read_in = 0;  ///< stage
};

/// All messages of a round, ascending by (from, sent_in, to): the order of targets().
/// Errors: std::logic_error if sources and targets do not mirror each other (names the pair), are not ascending, or if
/// a stage has two receivers. Cost: linear in messages, times the logarithm of neighbours.
std::vector<Message> plan_messages(Model& model);

}  // namespace moraine::runtime
