// SPDX-License-Identifier: Apache-2.0
// The table of scheduling policies.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "runtime/schedule/scheduler.hpp"

namespace moraine::runtime {

struct SchedulerRow {
  std::string_view name;
  std::string_view help;  ///< one line
  std::unique_ptr<Scheduler> (*make)();
};

std::span<const SchedulerRow> schedulers();

/// Errors: std::invalid_argument, listing the table, if there is none of that name.
const SchedulerRow& find_scheduler(std::string_view name);

}  // namespace moraine::runtime
