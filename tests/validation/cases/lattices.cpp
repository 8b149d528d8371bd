// SPDX-License-Identifier: Apache-2.0
// Waves in lattices of masses on springs: Mora & Place (1994), Pure Appl. Geophys. 143, 61.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

constexpr double stiffness = 1000, speed = 0.03;  // N/m of a bond, m/s; spheres of 1 kg, 1 m apart

struct Lattice {
  Vec3 a, b, c;  ///< of the cell
  double half;   ///< of the block that is cut out of it [m]: no wave from its sides is in its middle before the end
};

const Lattice triangular{{1, 0, 0}, {0.5, 0, std::sqrt(0.75)}, {0, 99, 0}, 6};
const Lattice fcc{Vec3{0, 1, 1} / std::numbers::sqrt2, Vec3{1, 0, 1} / std::numbers::sqrt2,
                  Vec3{1, 1, 0} / std::numbers::sqrt2, 5.7};

/// A plane wave of 20 m.
struct Wave {
  const Lattice& lattice;
  Vec3 along, motion;  ///< unit vectors

  double number() const { return 2 * std::numbers::pi / 20; }
};

std::vector<Vec3> points(const Lattice& l) {
  std::vector<Vec3> inside;
  const int most = static_cast<int>(2 * l.half);
  for (int i = -most; i <= most; ++i)
    for (int j = -most; j <= most; ++j)
      for (int k = -most; k <= most; ++k) {
        const Vec3 p = i * l.a + j * l.b + k * l.c;
        if (p.cwiseAbs().maxCoeff() <= l.half) inside.push_back(p);
      }
  return inside;
}

bool neighbours(const Vec3& p, const Vec3& q) { return std::abs((q - p).norm() - 1) < 1e-6; }

/// Of an unbounded lattice: m w^2 = K sum over neighbours r of (r . motion)^2 (1 - cos(q . r)) [rad/s].
double frequency(const Wave& wave) {
  double sum = 0;
  for (const Vec3& r : points(wave.lattice))
    if (neighbours(Vec3::Zero(), r))
      sum += std::pow(r.dot(wave.motion), 2) * (1 - std::cos(wave.number() * r.dot(wave.along)));
  return std::sqrt(stiffness * sum);
}

std::string scene_text(const Wave& wave, const std::vector<Vec3>& at) {
  std::string items, bonds;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec3 v = speed * std::cos(wave.number() * at[i].dot(wave.along)) * wave.motion;
    items += fmt::format("{{id: {}, at: [{:.17g}, {:.17g}, {:.17g}], velocity: [{:.17g}, {:.17g}, {:.17g}]}}, ", i,
                         at[i].x(), at[i].y(), at[i].z(), v.x(), v.y(), v.z());
    for (std::size_t j = i + 1; j < at.size(); ++j)
      if (neighbours(at[i], at[j])) bonds += fmt::format("{{a: {}, b: {}, stiffness: {}}}, ", i, j, stiffness);
  }
  return masses_on_springs(items, bonds);
}

/// Standing for an eighth of a period: the speed in the middle is then that at the start times cos(w t).
double error(const Setting& s, const Wave& wave) {
  const std::vector<Vec3> at = points(wave.lattice);
  const auto middle =
      static_cast<ElementId>(std::ranges::find_if(at, [](const Vec3& p) { return p.norm() < 1e-9; }) - at.begin());
  const double expected = frequency(wave), period = 2 * std::numbers::pi / expected;
  ModelRun run = trial(s, scene_text(wave, at), period / 1000);
  run_until(run, period / 8);
  const double now = run.of(middle).twist.linear.dot(wave.motion) / speed;
  return std::abs(std::acos(std::clamp(now, -1.0, 1.0)) / run.time() / expected - 1);
}

const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), diagonal = (x + y).normalized();

double triangular_p(const Setting& s) { return error(s, {triangular, x, x}); }
double triangular_s(const Setting& s) { return error(s, {triangular, x, z}); }
double fcc_p(const Setting& s) { return error(s, {fcc, x, x}); }
double fcc_p_diagonal(const Setting& s) { return error(s, {fcc, diagonal, diagonal}); }
double fcc_s(const Setting& s) { return error(s, {fcc, x, y}); }

}  // namespace

std::vector<Case> lattices() {
  return needing(needs_bonds,
                 {
                     {"B4 P wave, triangular", "20 m long, step T / 1000: for long ones c = 1.0607 a sqrt(K / m)",
                      triangular_p, 0.05, 0.01},
                     {"B4 S wave, triangular", "the same: 0.6124", triangular_s, 0.05, 0.01},
                     {"B4 P wave, FCC [100]", "the same: 1", fcc_p, 0.05, 0.01},
                     {"B4 P wave, FCC [110]", "the same: 1.1180", fcc_p_diagonal, 0.05, 0.01},
                     {"B4 S wave, FCC [100]", "the same: 0.7071", fcc_s, 0.05, 0.01},
                 });
}

}  // namespace moraine::test
