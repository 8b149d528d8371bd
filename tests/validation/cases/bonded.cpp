// SPDX-License-Identifier: Apache-2.0
// Bonds: a pair that swings, is damped, breaks; a chain along which a wave stands.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

const double period = 2 * std::numbers::pi / std::sqrt(2000.0);

/// Two spheres of 1 kg, 1 m apart, bonded with 1000 N/m, moving apart: stretched by 1 % at the most.
std::string pair(const std::string& bond) {
  return "parameters: {v: 0.01 * sqrt(2000) / 2}\nmaterials: {ball: {density: 1000}}\nelements:\n"
         "  - {packing: list, shape: {sphere: 0.1}, mass: 1, items: [{id: 1, at: [0, 0, 0], velocity: [-v, 0, 0]}, "
         "{id: 2, at: [1, 0, 0], velocity: [v, 0, 0]}]}\ntime: {dt: 1e-3, steps: 1}\n"
         "bonds: [{a: 1, b: 2, stiffness: 1000" +
         bond + "}]\n" + weightless;
}

double stretch(const ModelRun& run) { return run.position(2).x() - run.position(1).x() - 1; }

struct Swings {
  double period = 0, ratio = 0;  ///< [s]; of the amplitudes of successive periods
};

/// From upward zero crossings and the greatest stretches between them.
Swings swings(const Setting& s, const std::string& bond, int periods) {
  ModelRun run = trial(s, pair(bond), period / 100);
  const double dt = run.scene().time.dt;
  std::vector<double> crossings, peaks;
  double before = stretch(run), peak = 0;
  while (static_cast<int>(crossings.size()) < periods + 1 && run.time() < 2 * periods * period) {
    run.steps(1);
    const double now = stretch(run);
    peak = std::max(peak, now);
    if (before < 0 && now >= 0) {
      crossings.push_back(run.time() - dt * now / (now - before));
      peaks.push_back(peak);
      peak = 0;
    }
    before = now;
  }
  if (crossings.size() < 2) return {};
  const auto last = static_cast<double>(crossings.size() - 1);
  return {(crossings.back() - crossings.front()) / last, std::pow(peaks.back() / peaks.front(), 1 / last)};
}

double pair_period(const Setting& s) { return std::abs(swings(s, "", 20).period / period - 1); }
/// Of all of 100 periods.
double pair_energy(const Setting& s) { return std::abs(std::pow(swings(s, "", 50).ratio, 2 * 100) - 1); }
double pair_damping(const Setting& s) { return std::abs(swings(s, ", damping: 2", 8).ratio / 0.75482 - 1); }

/// One end is so heavy that it stands, the other pulled away at 0.01 m/s by a mass as heavy. In steps of 10 ms.
double pair_breaks(const Setting& s) {
  ModelRun run =
      trial(s,
            "materials: {ball: {density: 1000}}\nelements:\n"
            "  - {packing: list, shape: {sphere: 0.1}, items: [{id: 1, at: [0, 0, 0], mass: 1e7}, {id: 2, at: [1, "
            "0, 0], velocity: [0.01, 0, 0], mass: 1e7}]}\ntime: {dt: 1e-2, steps: 1}\n"
            "bonds: [{a: 1, b: 2, stiffness: 1000, break_length: 1.05}]\n" +
                weightless,
            1e-2);
  run_until(run, 4.9);
  while (run.model().statistics().bonds_broken == 0 && run.time() < 5.1) run.steps(1);
  return std::abs(run.time() - 5) / 1e-2;
}

constexpr int links = 20;

/// How much of the longest standing wave of a free chain there is in its speeds.
double mode(const ModelRun& run) {
  double sum = 0;
  int i = 0;
  for (const ElementState& e : run.model().states())
    sum += e.twist.linear.x() * std::cos(std::numbers::pi * (i++ + 0.5) / links);
  return sum;
}

/// Twenty masses m on springs K: w = 2 sqrt(K / m) sin(pi / 2N), from the zeros of the speeds.
double chain_wave(const Setting& s) {
  std::string items, bonds;
  for (int i = 0; i < links; ++i) {
    const double v = 0.1 * std::cos(std::numbers::pi * (i + 0.5) / links);
    items += fmt::format("{}{{id: {}, at: [{}, 0, 0], velocity: [{:.17g}, 0, 0]}}", i > 0 ? ", " : "", i, i, v);
    if (i > 0) bonds += fmt::format("{}{{a: {}, b: {}, stiffness: 1000}}", i > 1 ? ", " : "", i - 1, i);
  }
  const double expected = std::numbers::pi / std::sqrt(1000.0) / std::sin(std::numbers::pi / (2 * links));
  ModelRun run = trial(
      s,
      "materials: {ball: {density: 1000}}\nelements:\n  - {packing: list, shape: {sphere: 0.1}, mass: 1, items: [" +
          items + "]}\ntime: {dt: 1e-3, steps: 1}\nbonds: [" + bonds + "]\n" + weightless,
      expected / 1000);
  std::vector<double> zeros;
  for (double before = mode(run); zeros.size() < 3 && run.time() < 3 * expected;) {
    run.steps(1);
    const double now = mode(run);
    if (before * now < 0) zeros.push_back(run.time() - run.scene().time.dt * now / (now - before));
    before = now;
  }
  return zeros.size() < 3 ? 1 : std::abs((zeros[2] - zeros[0]) / expected - 1);
}

}  // namespace

std::vector<Case> bonded() {
  std::vector<Case> all{
      {"B1 pair, period", "T = 2 pi / sqrt(2 k / m), step T / 100", pair_period, 0.01, 0.001},
      {"B1 pair, energy", "kept over 100 periods", pair_energy, 0.01, 0.001},
      {"B1 pair, damping", "zeta = 0.0447: amplitude falls to 0.7548 in a period", pair_damping, 0.01, 0.01},
      {"B2 pair breaks", "at its length; in steps of 10 ms", pair_breaks, 1, 1},
      {"B4 wave in a chain", "of 20: w = 2 sqrt(K / m) sin(pi / 40), step T / 1000", chain_wave, 0.05, 0.01},
  };
  for (Case& c : all) c.needs = needs_bonds;
  return all;
}

}  // namespace moraine::test
