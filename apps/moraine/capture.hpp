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
/// Collective; complete on rank 0. `loop_cpu_s`: processor time of this rank.
Summary summarise(const CoupledModel& model, runtime::Simulation& simulation, double wall_s, double loop_wall_s,
                  double loop_cpu_s);

}  // namespace moraine::app
