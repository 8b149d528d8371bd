// SPDX-License-Identifier: Apache-2.0
// The factories of all scheduling policies, for their table.
#pragma once

#include <memory>

#include "runtime/schedule/scheduler.hpp"

namespace moraine::runtime {

std::unique_ptr<Scheduler> make_serial();
std::unique_ptr<Scheduler> make_barrier();
std::unique_ptr<Scheduler> make_stealing();
std::unique_ptr<Scheduler> make_critical_path();
std::unique_ptr<Scheduler> make_hybrid();

}  // namespace moraine::runtime
