// SPDX-License-Identifier: Apache-2.0
// How a scene is to be run: defaults, overridden by the scene file, the environment (MORAINE_...), the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace moraine {

struct TimeSettings {
  double dt = 0;  ///< one step [s]
  std::int64_t steps = 0;
  int substeps = 1;  ///< engine steps per step; sub-models are coupled after each
  struct Label {
    std::string unit;     ///< e.g. "year"; empty: seconds
    double per_step = 0;  ///< label units per step
  } label;
  double substep() const { return dt / substeps; }
};

struct RunSettings {
  std::string engine = "bullet";
  std::string engine_profile = "default";  ///< declared limits: "default" or "physx" (the limits of PhysX scenes)
  int sub_models = 0;                      ///< 0: auto, from measured engine cost and ghost share
  std::string split = "auto";
  std::string coupling = "auto";  ///< auto: the first that fits the engine
  std::optional<double>
      coupling_leak;  ///< part of the carried impulse that survives a substep, 0 .. 1; or the engine's
  double skin = 0;    ///< ghosts are made for gaps below this [element diameters]; 0: the coupling's own
  double recut_ghost_share =
      0.5;                    ///< re-cut when ghosts / elements exceeds this and 1.3 times the share after the last cut
  double skip_threshold = 0;  ///< sub-models slower than this are skipped [sqrt(g d)]; 0: none
  int iterations = 10;        ///< solver iterations per substep
  double overlap_recovery = 0.1;  ///< share of an overlap that an engine removes per substep; 0 .. 1
  std::string scheduler = "hybrid";
  int threads = 0;                  ///< of each rank; 0: its share of the cores it may use
  std::string balancer = "refine";  ///< which rank owns which sub-model
  std::vector<int> owners;          ///< sub-models that each rank owns at first, in order; empty: blocks of even size
  int balance_every = 1;            ///< steps from one balance to the next, at least
  bool balance_measured = true;     ///< by measured time; else by counted work: the same plans every time
  std::string load_prediction = "last";  ///< the next load of a sub-model from its last ones
  int checkpoint_every = 0;              ///< steps from one checkpoint to the next, at least; 0: none
  std::string restart;                   ///< folder of a checkpoint, or "latest"; empty: from the start
  std::string trace;                     ///< file of what ran where and when; empty: none
  struct TraceWindow {
    std::int64_t from = 0;   ///< steps from .. to - 1
    std::int64_t to = -1;    ///< -1: to the end
    std::int64_t every = 1;  ///< of the epochs in there, every so many
  } trace_window;
  double max_speed = 0;  ///< runaway limit [m/s]; 0: from the scene's energy
};

struct OutputSettings {
  std::string folder;                          ///< empty: out/NAME
  bool quiet = false;                          ///< no progress and no table at the end
  int every = 0;                               ///< steps between frames; 0: first and last only
  std::vector<std::string> formats = {"pvd"};  ///< pvd, vtkhdf, lammps_dump, csv
  bool pictures = true;                        ///< PNG of the first and last frame
  int picture_width = 1200;                    ///< pixels
};

}  // namespace moraine
