// SPDX-License-Identifier: Apache-2.0
// Who wants to know what ran where and when.
#pragma once

#include "runtime/trace/trace.hpp"

namespace moraine::runtime {

class TaskObserver {
 public:
  virtual ~TaskObserver() = default;
  /// Called for every task that ended well, from the thread that ran it. Calls for one worker never overlap; those for
  /// different workers do. Epoch, rank, bytes and counters are not filled in.
  virtual void task_done(const TaskRecord& record) = 0;
};

}  // namespace moraine::runtime
