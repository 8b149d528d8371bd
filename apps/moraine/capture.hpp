// SPDX-License-Identifier: Apache-2.0
// What a model looks like at one moment, and what a run amounted to.
#pragma once

#include "ghosting/model.hpp"
#include "output/frame.hpp"
#include "output/summary.hpp"
#include "runtime/simulation.hpp"

namespace moraine::app {

/// Collective; complete on rank 0, empty elsewhere.
Frame capture(const CoupledModel& model, runtime::Transport& transport, std::int64_t step);
/// What this process did of a run, which may have begun in another one.
struct Spent {
  double wall_s = 0, loop_wall_s = 0;
  double loop_cpu_s = 0;    ///< processor time of this rank
  std::int64_t rounds = 0;  ///< taken in the loop
};

/// Collective; complete on rank 0.
Summary summarise(const CoupledModel& model, runtime::Simulation& simulation, const Spent& spent);

}  // namespace moraine::app
