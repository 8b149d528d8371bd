// SPDX-License-Identifier: Apache-2.0
// What a run amounts to: summary.json, and a short table for the terminal.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "output/frame.hpp"

namespace moraine {

/// SI units. The members are the keys of summary.json; nested ones are objects there.
struct Summary {
  std::string scene, engine, precision, coupling, split, scheduler, balancer;
  int ranks = 1;
  int threads_per_rank = 1;
  std::uint64_t elements = 0;
  std::uint32_t sub_models = 0;
  std::int64_t steps = 0;
  int substeps = 1;
  double dt = 0;                     ///< of a step [s]
  double time = 0;                   ///< simulated, at the end [s]
  double wall_s = 0;                 ///< with reading and writing
  double loop_wall_s = 0;            ///< the steps alone
  double loop_cpu_s = 0;             ///< processor time of the same, sum over threads and ranks
  double element_steps_per_s = 0;    ///< elements x steps x substeps / loop_wall_s
  std::uint64_t peak_rss_bytes = 0;  ///< sum over ranks
  std::string state_hash;            ///< 16 hex digits
  struct Ghosts {
    double mean = 0;
    std::uint64_t max = 0, final = 0;
    double fraction_mean = 0, fraction_final = 0;  ///< of the elements
  } ghosts;
  double rested = 0;  ///< share of the elements that were skipped at rest, mean over the run
  struct Bonds {
    std::uint64_t total = 0, broken = 0;
  } bonds;
  struct Residual {
    double linear = 0, angular = 0;
  } momentum_residual;        ///< relative: change not explained by external impulse
  double kinetic_energy = 0;  ///< [J]
  struct Energy {
    double kinetic = 0, potential = 0, bond = 0, contact = 0, work_of_boundaries = 0, dissipated = 0, gained = 0;
  } energy;                                ///< [J]; see docs/output.md
  std::array<double, 3> boundary_force{};  ///< that boundaries exert, mean over the last fifth of the run [N]
  std::array<double, 3> center_of_mass{};
  double x95 = 0;  ///< 95 % of the elements have a smaller x [m]
  /// So many per cent of the elements have smaller coordinates [m].
  std::map<int, std::array<double, 3>> quantiles;
  struct Overlap {
    double max = 0, mean = 0;
  } overlap;  ///< [element diameters]
  double coupling_residual = 0;
  struct Load {
    double imbalance = 1;         ///< largest over mean busy time
    double utilisation = 0;       ///< share of the threads' time spent in tasks
    double waiting_fraction = 0;  ///< share spent waiting for others
    std::uint64_t migrations = 0;
  } load;
  /// Where the time of workers went: shares of it, over ranks.
  struct Profile {
    struct Share {
      double min = 0, mean = 0, max = 0;
    };
    Share busy, imbalance, messages, scheduling, between;
    struct Costly {
      std::uint32_t sub_model = 0;
      double share = 0;  ///< of the busy time
    };
    std::vector<Costly> costliest;
    struct Cure {
      std::string change;  ///< what to do; empty: nothing that was tried helps
      double gain = 0;     ///< predicted, a share of the run time
    } cure;
    std::string sentence;  ///< all that in one
  } profile;
  struct Balance {
    double seconds = 0;      ///< spent by the slowest rank on collecting, planning, moving
    double moved_bytes = 0;  ///< by all ranks
    struct Round {
      std::int64_t step = 0;
      double imbalance = 1;  ///< max/mean busy time of ranks since the round before
      double forecast = 1;   ///< with the owners proposed
      double gain_s = 0;     ///< forecast; the owners change if it exceeds the cost
      double cost_s = 0;
      std::int64_t moves = 0;  ///< carried out
      double bytes = 0;
    };
    std::vector<Round> rounds;
  } balance;
  struct Messages {
    double per_round = 0;        ///< between sub-models
    double bytes_per_round = 0;  ///< without envelopes
    double between_ranks = 0;    ///< of per_round
    double pairs = 0;            ///< of sub-models, one way, mean over epochs
  } messages;
  std::map<std::string, double> step_share;  ///< share of the busy time per stage
  std::uint64_t recuts = 0;                  ///< times the scene was split anew
  std::vector<std::string> warnings;
};

/// Replaces `path` in one move; numbers that are not finite become null. Errors: IoError naming the path.
void write_summary(const Summary& summary, const std::filesystem::path& path);

/// A few aligned lines, warnings last.
std::string summary_text(const Summary& summary);

/// The coordinate along `axis` (0 .. 2) that `share` (0 .. 1) of the bodies lie below, the nearest rank; 0 if there are
/// none [m]. Cost: linear.
double quantile(std::span<const ElementState> bodies, int axis, double share);

}  // namespace moraine
