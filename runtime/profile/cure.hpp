// SPDX-License-Identifier: Apache-2.0
// What would make a run faster: replays of it with one thing changed, and the best of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/replay/replay.hpp"

namespace moraine::runtime {

/// Kinds of change, in the order in which they are preferred if they promise the same.
enum class Change {
  scheduler,
  balancer,
  less_output,  ///< a quarter of the time that frames take
  layout,       ///< other ranks and threads
  finer_cut     ///< more sub-models; results change a little
};

struct Cure {
  Change change = Change::scheduler;
  ReplayOptions options{};
  std::size_t pieces = 1;  ///< of each sub-model
  bool fits = true;        ///< on the cores of the traced machine
  Prediction prediction{};
  double gain = 0;  ///< of the makespan as it was, a share; negative: slower
};

struct Cures {
  Prediction now{};  ///< the replay of the run as it was: gains are relative to it
  std::vector<Cure> tried{};
  std::optional<std::size_t> best{};  ///< place in `tried`; none: nothing promises least_gain

  static constexpr double least_gain = 0.01;
};

struct CureSearch {
  double cores = 0;                                                ///< of the traced machine
  std::vector<double> halo{};                                      ///< as of cut_finer()
  std::function<void(const Cure&)> progress = [](const Cure&) {};  ///< told of each before it is tried
};

/// Tries every scheduler; every balancer that moves for gain; other layouts with as many workers, with as many as
/// there are cores, and with half and twice as many; sub-models cut in 2, 4 and 8; a quarter of the output. The best
/// gains most on the traced machine; of those within a hundredth of it, the first in the order of Change. Layouts are
/// left out if traced workers shared cores: the seconds of tasks then hold waiting for a core. Cost: some 20 replays.
Cures find_cures(const Workload& work, const CureSearch& search);

/// What to do, as options of the command: "--scheduler stealing".
std::string words(const Cure& cure, const Workload& work);

}  // namespace moraine::runtime
