// SPDX-License-Identifier: Apache-2.0
// How fast errors fall with the step. The error of these cases is the distance of the measured order from that of
// theory.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/validation/cases/case.hpp"

namespace moraine::test {
namespace {

constexpr double g = 9.81;

/// From the errors at steps of 4 h, 2 h and h: the slope of their logarithms.
template <class Error>
double order(double h, const Error& error) {
  return std::log2(std::abs(error(4 * h) / error(h))) / 2;
}

/// Symplectic Euler: the first. Verlet has no error: its order counts as met.
double free_fall(const Setting& s) {
  const auto error = [&](double dt) {
    ModelRun run = trial(s, spheres("{id: 1, at: [0, 0, 100]}", ball(s, "friction: 0"), ""), dt, {}, 1);
    run_until(run, 1);
    return run.position(1).z() - (100 - 0.5 * g * run.time() * run.time());
  };
  return s.springs() ? std::abs(error(1e-3)) : std::abs(order(1e-3, error) - 1);
}

/// Where an elastic ball turns again after it has fallen from 1 m: impulses find it late by up to a step, to the first
/// order; a spring and Verlet keep the energy to the second. Largest error of 16 phases of the step.
double elastic_bounce(const Setting& s) {
  const auto error = [&](double h) {
    double most = 0;
    for (int phase = 0; phase < 16; ++phase) {
      const double from = 1 + 4.43 * h * phase / 16;
      ModelRun run = trial(
          s,
          spheres(fmt::format("{{id: 1, at: [0, 0, {:.17g}]}}", 0.1 + from), ball(s, "restitution: 1"), floor_at_zero),
          h, {}, 1);
      run_until(run, 1.5 * std::sqrt(2 * from / g));
      const double energy = g * (run.position(1).z() - 0.1) + 0.5 * run.velocity(1).squaredNorm();
      most = worst_of({most, std::abs(energy / (g * from) - 1)});
    }
    return most;
  };
  return std::abs(order(s.springs() ? 1e-5 : 5e-4, error) - (s.springs() ? 2 : 1));
}

/// T of a bonded pair: the second order, explicit or implicit.
double pair_period(const Setting& s) {
  const double period = 2 * std::numbers::pi / std::sqrt(2000.0);
  const auto error = [&](double dt) {
    ModelRun run = trial(
        s,
        "parameters: {v: 0.1}\nmaterials: {ball: {density: 1000}}\nelements:\n  - {packing: list, shape: {sphere: "
        "0.1}, mass: 1, items: [{id: 1, at: [0, 0, 0], velocity: [-v, 0, 0]}, {id: 2, at: [1, 0, 0], velocity: "
        "[v, 0, 0]}]}\ntime: {dt: 1e-3, steps: 1}\nbonds: [{a: 1, b: 2, stiffness: 1000}]\n" +
            weightless,
        dt, {}, 1);
    const auto stretch = [&] { return run.position(2).x() - run.position(1).x() - 1; };
    int crossings = 0;
    double before = stretch();
    for (;;) {
      run.steps(1);
      const double now = stretch();
      if (before < 0 && now >= 0 && ++crossings == 5) return (run.time() - dt * now / (now - before)) / 5 - period;
      before = now;
    }
  };
  return std::abs(order(period / (s.springs() ? 4000 : 200), error) - 2);
}

/// How deep the lowest of three stacked spheres is in the floor. Where impulses let it sink it is by what it falls in a
/// substep: the second order at least, or not at all. A spring gives by its stiffness, whatever the step.
double stack_overlap(const Setting& s) {
  const auto sunk = [&](double dt) {
    ModelRun run = trial(s,
                         spheres("{id: 1, at: [0, 0, 0.1]}, {id: 2, at: [0, 0, 0.3]}, {id: 3, at: [0, 0, 0.5]}",
                                 ball(s, "restitution: 0"), floor_at_zero),
                         dt, {}, 1);
    run_until(run, 2);
    return 0.1 - run.position(1).z();
  };
  if (s.springs()) return std::abs(sunk(1e-3) / (3 * g / 1e6) - 1);
  return std::abs(sunk(4e-3)) < 1e-7 ? 0 : worst_of({0, 2 - order(1e-3, sunk)});
}

}  // namespace

std::vector<Case> orders() {
  return {
      {"O1 free fall", "order 1 in the step (springs: exact)", free_fall, 0.05, 1e-9},
      {"O2 elastic bounce", "energy: order 1 in the step (springs: 2)", elastic_bounce, 0.2, 0.2},
      {"O3 bonded pair", "period: order 2 in the step", pair_period, 0.2, 0.2, needs_bonds},
      {"O4 stack on a floor", "depth: at least order 2 in the step, or none (springs: weight / stiffness)",
       stack_overlap, 0.2, 0.01},
  };
}

}  // namespace moraine::test
