// SPDX-License-Identifier: Apache-2.0
#include "ghosting/accounts.hpp"

#include <algorithm>
#include <cmath>

namespace moraine {
namespace {

double relative(double x, double scale) { return scale > 0 ? x / scale : x; }

Ledger sum(const std::vector<Report>& reports, Ledger ledger) {
  for (const Report& r : reports) ledger += r.ledger;
  return ledger;
}

EnergyAccount energy(const Ledger& opening, const Ledger& now, double gained) {
  return {now.kinetic_energy,
          now.potential_energy,
          now.bond_energy,
          now.contact_energy,
          now.work,
          opening.energy() + now.work - now.energy(),
          gained};
}

}  // namespace

std::uint64_t ghosts(const std::vector<Report>& reports) {
  std::uint64_t sum = 0;
  for (const Report& r : reports) sum += r.ghosts;
  return sum;
}

void Accounts::note_extremes(const std::vector<Report>& reports) {
  const Ledger now = sum(reports, closed);
  ghosts_max = std::max(ghosts_max, ghosts(reports));
  speed_sum_max = std::max(speed_sum_max, now.speed_sum);
  spin_scale_max = std::max(spin_scale_max, now.spin_scale);
  kinetic_max = std::max(kinetic_max, now.kinetic_energy);
  bond_max = std::max(bond_max, now.bond_energy);
  const double left = now.energy() - now.work;
  least_energy = std::min(least_energy, left);
  gained = std::max(gained, left - least_energy);
}

void Accounts::mark(const std::vector<Report>& reports, std::int64_t round) {
  marked_round = round;
  marked_impulse = sum(reports, closed).from_boundaries;
}

void Accounts::take_over(const std::vector<Report>& reports) {
  rounds += reports.front().rounds;
  for (const Report& r : reports) {
    closed.given += r.ledger.given;
    closed.from_boundaries += r.ledger.from_boundaries;
    closed.work += r.ledger.work;
    closed.exchanged += r.ledger.exchanged;
    closed.exchanged_angular += r.ledger.exchanged_angular;
    disagreement += r.disagreement;
    disagreements += r.disagreements;
    ghost_rounds += r.ghost_rounds;
    rested += r.rested;
    broken_bonds.insert(broken_bonds.end(), r.broken_bonds.begin(), r.broken_bonds.end());
  }
  std::sort(broken_bonds.begin(), broken_bonds.end());
  broken_bonds.erase(std::unique(broken_bonds.begin(), broken_bonds.end()), broken_bonds.end());
  ++recuts;
}

ModelStatistics Accounts::statistics(const std::vector<Report>& reports, double speed, double time_since_mark) const {
  Accounts all = *this;
  if (!reports.empty()) all.take_over(reports);
  ModelStatistics s;
  s.recuts = recuts;
  s.ledger = sum(reports, closed);
  s.bonds_broken = all.broken_bonds.size();
  s.ghosts_now = ghosts(reports);
  s.ghosts_max = std::max(ghosts_max, ghosts(reports));
  s.ghosts_mean = static_cast<double>(all.ghost_rounds) / static_cast<double>(std::max<std::uint64_t>(1, all.rounds));
  s.rested_mean = static_cast<double>(all.rested) / static_cast<double>(std::max<std::uint64_t>(1, all.rounds));
  const Vec3 linear = s.ledger.momentum.linear - opening.momentum.linear - s.ledger.given.linear;
  const Vec3 angular = s.ledger.momentum.angular - opening.momentum.angular - s.ledger.given.angular;
  s.linear_residual = relative(linear.norm(), std::max({speed_sum_max, s.ledger.speed_sum, s.ledger.exchanged}));
  s.angular_residual =
      relative(angular.norm(), std::max({spin_scale_max, s.ledger.spin_scale, s.ledger.exchanged_angular}));
  s.energy = energy(opening, s.ledger, gained);
  if (time_since_mark > 0) s.boundary_force = (s.ledger.from_boundaries - marked_impulse) / time_since_mark;
  if (all.disagreements > 0)
    s.coupling_residual = std::sqrt(all.disagreement / static_cast<double>(all.disagreements)) / speed;
  return s;
}

}  // namespace moraine
