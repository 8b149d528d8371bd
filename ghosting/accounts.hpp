// SPDX-License-Identifier: Apache-2.0
// What a run has added up to so far, over all sub-models and all cuts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ghosting/report.hpp"

namespace moraine {

/// Where energy is, came from and went [J].
struct EnergyAccount {
  double kinetic = 0, potential = 0, bond = 0, contact = 0;  ///< now; as in Ledger
  double work_of_boundaries = 0;                             ///< since the start
  double dissipated = 0;                                     ///< at the start + work - now
  /// The most by which energy less work rose above the least it had been: more than rounding is energy from nowhere.
  double gained = 0;
};

/// Counts and residuals of a run so far.
struct ModelStatistics {
  double ghosts_mean = 0;
  std::size_t ghosts_max = 0;
  std::size_t ghosts_now = 0;
  double rested_mean = 0;  ///< elements that did not advance in a round, for they were at rest
  std::size_t bonds_broken = 0;
  std::size_t recuts = 0;
  double linear_residual = 0;    ///< unexplained momentum / larger of the largest sum of m|v| and the impulse exchanged
  double angular_residual = 0;   ///< the same for angular momentum about the world origin
  double coupling_residual = 0;  ///< rms speed by which copies disagreed / sqrt(g d)
  EnergyAccount energy;
  Vec3 boundary_force = Vec3::Zero();  ///< mean since `marked_round` [N]
  Ledger ledger;
};

/// Of all sub-models, now.
std::uint64_t ghosts(const std::vector<Report>& reports);

/// Kept alike on all ranks, from the reports of all sub-models.
struct Accounts {
  Ledger opening;  ///< at the start of the run
  Ledger closed;   ///< given and exchanged by sub-models of earlier cuts
  std::size_t recuts = 0;
  double disagreement = 0;  ///< as in Report, of earlier cuts; so are the next four
  std::uint64_t disagreements = 0, ghost_rounds = 0, rounds = 0, rested = 0;
  std::vector<std::uint32_t> broken_bonds;  ///< ascending
  std::uint64_t ghosts_max = 0;
  double speed_sum_max = 0, spin_scale_max = 0;
  double kinetic_max = 0, bond_max = 0;                           ///< [J]
  double least_energy = std::numeric_limits<double>::infinity();  ///< less the work of boundaries [J]
  double gained = 0;                                              ///< as in EnergyAccount
  std::int64_t marked_round = 0;                                  ///< where the mean of boundary forces begins
  Vec3 marked_impulse = Vec3::Zero();                             ///< of boundaries until then [N s]

  /// Between epochs: extremes that would be missed at the end.
  void note_extremes(const std::vector<Report>& reports);
  /// Boundary forces are averaged from this round on.
  void mark(const std::vector<Report>& reports, std::int64_t round);
  /// Sub-models about to be replaced leave what they counted.
  void take_over(const std::vector<Report>& reports);
  /// `speed`: sqrt(g d) [m/s]; `time_since_mark` [s].
  ModelStatistics statistics(const std::vector<Report>& reports, double speed, double time_since_mark) const;
};

}  // namespace moraine
