// SPDX-License-Identifier: Apache-2.0
#include "runtime/schedule/registry.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string>

#include "runtime/schedule/policies.hpp"

namespace moraine::runtime {
namespace {

constexpr std::array table{
    SchedulerRow{"serial", "one thread, in the order of a plain loop: for debugging and as a reference", make_serial},
    SchedulerRow{"barrier", "all sub-models finish a stage before any starts the next, fixed blocks per thread",
                 make_barrier},
    SchedulerRow{"stealing", "each thread goes on with what it released, oldest first; idle threads steal",
                 make_stealing},
    SchedulerRow{"critical_path", "the longest chain of predicted work first, on any idle thread", make_critical_path},
    SchedulerRow{"hybrid", "sub-models stay with one thread while it keeps up, idle threads take what is behind",
                 make_hybrid},
};

}  // namespace

std::span<const SchedulerRow> schedulers() { return table; }

const SchedulerRow& find_scheduler(std::string_view name) {
  std::string known;
  for (const SchedulerRow& row : table) {
    if (row.name == name) return row;
    known += fmt::format("\n  {:<14} {}", row.name, row.help);
  }
  throw std::invalid_argument(fmt::format("no scheduler is called '{}'; there are:{}", name, known));
}

}  // namespace moraine::runtime
