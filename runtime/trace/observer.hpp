// SPDX-License-Identifier: Apache-2.0
// Who wants to know what ran where and when.
#pragma once

#include <chrono>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

struct EndedTask {
  int stage = 0;
  SubModelId sub_model = 0;
  Round round;
  int worker = 0;
  std::chrono::steady_clock::time_point start;
  std::chrono::steady_clock::time_point end;
};

class TaskObserver {
 public:
  virtual ~TaskObserver() = default;
  /// Called once for every task that ended well, from its thread, one call at a time. All workers wait meanwhile.
  virtual void task_done(const EndedTask& record) = 0;
};

}  // namespace moraine::runtime
