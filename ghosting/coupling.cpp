// SPDX-License-Identifier: Apache-2.0
// The table of couplings, and the rotations they share.
#include "ghosting/coupling.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "physics/errors.hpp"

namespace moraine {

std::span<const CouplingRow> couplings() {
  static const std::array table{
      CouplingRow{"consensus", "copies share the mass; their mean is the element, what each carries is passed on",
                  make_consensus},
      CouplingRow{"mirror", "full-mass ghosts in both worlds that receive their parent's last forces (2009; unstable)",
                  make_mirror},
      CouplingRow{"exact",
                  "ghosts show their owner's state; for engines whose forces follow from it: bit for bit uncut",
                  make_exact, GhostKind::follower, 0.2},
  };
  return table;
}

const CouplingRow& find_coupling(std::string_view name, const Engine& engine) {
  std::string known, fitting;
  for (const CouplingRow& row : couplings()) {
    const bool fits = row.ghosts == engine.ghosts;
    if (fits && (name == row.name || name == "auto")) return row;
    if (fits) fitting += fmt::format("{}{}", fitting.empty() ? "" : ", ", row.name);
    known += fmt::format("\n  {:<12} {}", row.name, row.help);
  }
  for (const CouplingRow& row : couplings())
    if (name == row.name)
      throw InputError(
          fmt::format("coupling {} does not fit engine {}, expected auto or one of: {}", name, engine.name, fitting));
  throw InputError(fmt::format("unknown coupling '{}', expected auto or one of:{}", name, known));
}

Quat rotated(const Quat& q, const Vec3& rotation) {
  const double angle = rotation.norm();
  if (angle == 0) return q;
  return (Quat(Eigen::AngleAxisd(angle, rotation / angle)) * q).normalized();
}

Vec3 rotation_between(const Quat& from, const Quat& to) {
  Quat d = to * from.conjugate();
  if (d.w() < 0) d.coeffs() = -d.coeffs();
  const double s = d.vec().norm();
  if (s == 0) return Vec3::Zero();
  return d.vec() * (2 * std::atan2(s, d.w()) / s);
}

}  // namespace moraine
