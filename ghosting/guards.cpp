// SPDX-License-Identifier: Apache-2.0
#include "ghosting/guards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/errors.hpp"

namespace moraine {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

Worst of_all(double value) { return {value, 0}; }

// --- what is looked at

Worst speed(const Watch& w) { return {w.extremes.speed.value / w.context.speed_limit, w.extremes.speed.element}; }
Worst stride(const Watch& w) { return w.extremes.stride; }
Worst beyond(const Watch& w) { return w.extremes.beyond; }
Worst below(const Watch& w) { return w.extremes.below; }
Worst linear(const Watch& w) { return of_all(w.linear_residual); }
Worst angular(const Watch& w) { return of_all(w.angular_residual); }
Worst coupling(const Watch& w) { return of_all(w.disagreement); }

Worst substep(const Watch& w) {
  const StepLimit& advised = w.context.advised;
  return {w.context.world.substep / advised.substep, 0};
}

Worst start(const Watch& w) { return {w.context.start.depth, w.context.start.element}; }
Worst overlap(const Watch& w) { return of_all(w.overlap); }

/// Energy that is allowed to come and go: 1/20 of what lifts all elements by a diameter (overlaps that are taken back
/// lift what lies on them), of the largest kinetic energy (dense flow with restitution across a cut), and of what
/// swings in bonds (an explicit step of a spring keeps its energy to within h w / 2, but on average). Ten times that is
/// half of all there has been, and in a run that blows up nearly all is gained: so the limit that stops is reached
/// then.
Worst energy(const Watch& w) {
  const double unit = w.context.world.length_unit / w.context.world.time_unit;
  const double lift = w.context.scene->gravity.isZero() ? 0 : w.accounts.opening.mass * unit * unit;
  const Accounts& a = w.accounts;
  const double allowed = 0.05 * (lift + a.kinetic_max + std::min(a.kinetic_max, a.bond_max));
  return {allowed > 0 ? a.gained / allowed : 0, w.extremes.speed.element};
}

// --- what is said

std::string more_substeps(const ModelContext& c, double ratio) {
  return fmt::format("use at least {:.0f} substeps or a smaller dt",
                     std::ceil(ratio * static_cast<double>(c.scene->time.substeps)));
}

std::string say_substep(const ModelContext& c, const Worst& w, std::int64_t) {
  return fmt::format("a substep of {:.3g} s is {:.1f} times what engine {} resolves well: {:.3g} s, set by {}; {}",
                     c.world.substep, w.value, c.engine->name, c.advised.substep, c.advised.reason,
                     more_substeps(c, w.value));
}

std::string say_start(const ModelContext& c, const Worst& w, std::int64_t) {
  const InitialOverlap& s = c.start;
  return fmt::format(
      "element {} overlaps {} {} by {:.0f} % of its diameter at the start and will be pushed out: place "
      "elements apart",
      w.element, s.with_boundary ? "boundary" : "element", s.other, 100 * w.value);
}

std::string say_overlap(const ModelContext&, const Worst& w, std::int64_t step) {
  return fmt::format(
      "the largest overlap is {:.2g} diameters at step {}: use more substeps, more iterations or stiffer "
      "contacts",
      w.value, step);
}

std::string say_speed(const ModelContext& c, const Worst& w, std::int64_t step) {
  return fmt::format(
      "element {} has {:.0f} % of the runaway speed {:.4g} m/s at step {}: use a smaller dt or more "
      "substeps, or raise run.max_speed if it should be that fast",
      w.element, 100 * w.value, c.speed_limit, step);
}

std::string say_stride(const ModelContext& c, const Worst& w, std::int64_t step) {
  return fmt::format(
      "element {} goes {:.2g} of its radius within a substep at step {}: from 1 on it can pass through "
      "others and through thin walls (tunnelling); {}",
      w.element, w.value, step, more_substeps(c, 2 * w.value));
}

std::string say_beyond(const ModelContext&, const Worst& w, std::int64_t step) {
  return fmt::format(
      "element {} has its centre {:.2g} radii behind a boundary that held it at the start, at step {}: "
      "use a smaller dt or more substeps, more iterations, or stiffer contacts",
      w.element, w.value, step);
}

std::string say_below(const ModelContext&, const Worst& w, std::int64_t step) {
  return fmt::format(
      "element {} is below all boundaries at step {} and will fall for ever: close the container, or put "
      "a plane under it",
      w.element, step);
}

std::string say_energy(const ModelContext& c, const Worst& w, std::int64_t step) {
  return fmt::format(
      "energy has risen by {:.2g} times what rounding and overlaps explain, more than boundaries worked, "
      "by step {} (the fastest is element {}): use more substeps or a smaller dt{}",
      w.value, step, w.element, c.followers() ? "" : ", a smaller run.overlap_recovery, fewer sub-models");
}

std::string say_linear(const ModelContext& c, const Worst& w, std::int64_t step) {
  const std::string cause =
      c.rest.on()
          ? "sub-models at rest are skipped; lower run.skip_threshold"
          : fmt::format("coupling {} does not keep it; use coupling auto or more substeps", c.scene->run.coupling);
  return fmt::format("{:.2g} of the momentum exchanged is unexplained by step {}: {}", w.value, step, cause);
}

std::string say_angular(const ModelContext&, const Worst& w, std::int64_t step) {
  return fmt::format(
      "{:.2g} of the angular momentum exchanged is unexplained by step {}: use more substeps or more "
      "iterations",
      w.value, step);
}

std::string say_coupling(const ModelContext&, const Worst& w, std::int64_t step) {
  return fmt::format(
      "copies of elements at cuts disagree by {:.2g} sqrt(g d) at step {}: use more substeps, fewer "
      "sub-models, or another split",
      w.value, step);
}

void note(GuardLog::Entry& e, const Worst& seen, std::int64_t step) {
  if (e.count == 0) {
    e.first = seen;
    e.first_step = step;
  }
  if (e.count == 0 || seen.value > e.worst.value) {
    e.worst = seen;
    e.worst_step = step;
  }
  ++e.count;
}

std::string prefixed(const Guard& guard, const std::string& text) { return fmt::format("{}: {}", guard.name, text); }

}  // namespace

std::span<const Guard> guards() {
  static const std::array table{
      Guard{"substep", "length of a substep / what the engine resolves well", 2, never, substep, say_substep},
      Guard{"start", "deepest overlap of a sphere at the start / diameter", 0.05, never, start, say_start},
      Guard{"overlap", "largest overlap at the end / typical diameter", 0.1, never, overlap, say_overlap},
      Guard{"runaway", "largest speed / run.max_speed, or what the scene can explain; watched in every substep", 0.5,
            never, speed, say_speed},
      Guard{"tunnelling", "way of an element within a substep / its inner radius", 0.5, never, stride, say_stride},
      Guard{"escape", "depth of a centre behind a plane or closed mesh that held it / radius", 1e-6, 1, beyond,
            say_beyond},
      Guard{"falling", "depth of a centre below all boundaries / radius", 1, never, below, say_below},
      Guard{"energy", "energy gained, less work of boundaries / what rounding and overlaps explain", 1, 10, energy,
            say_energy},
      Guard{"momentum", "linear momentum unexplained / exchanged", 1e-3, 0.1, linear, say_linear},
      Guard{"spin", "angular momentum unexplained / exchanged", 1e-2, never, angular, say_angular},
      Guard{"coupling", "rms speed by which copies of an element disagree / sqrt(g d)", 0.5, never, coupling,
            say_coupling},
  };
  return table;
}

void GuardLog::look(const Watch& watch, std::int64_t step) {
  ++looks;
  for (std::size_t g = 0; g < entries.size(); ++g) {
    const Guard& guard = guards()[g];
    const Worst seen = guard.look(watch);
    const auto text = [&] { return prefixed(guard, guard.text(watch.context, seen, step)); };
    if (seen.value >= guard.stops)
      throw InvalidStateError(fmt::format("{} (the limit is {:.3g})", text(), guard.stops));
    if (!(seen.value >= guard.warns)) continue;
    note(entries[g], seen, step);
    if (entries[g].count == 1) news_.push_back(text());
  }
}

double GuardLog::disagreement_since(const Accounts& accounts, const std::vector<Report>& reports) {
  double sum = accounts.disagreement;
  std::uint64_t count = accounts.disagreements;
  for (const Report& r : reports) {
    sum += r.disagreement;
    count += r.disagreements;
  }
  const double more = sum - std::exchange(disagreement, sum);
  const std::uint64_t times = count - std::exchange(disagreements, count);
  return times > 0 ? std::sqrt(std::max(0.0, more) / static_cast<double>(times)) : 0;
}

std::vector<std::string> GuardLog::warnings(const ModelContext& context) const {
  std::vector<std::string> out;
  for (std::size_t g = 0; g < entries.size(); ++g) {
    const Entry& e = entries[g];
    if (e.count == 0) continue;
    std::string text = prefixed(guards()[g], guards()[g].text(context, e.first, e.first_step));
    if (e.worst.value > e.first.value)
      text +=
          fmt::format(" (in {} of {} looks, at worst {:.3g} at step {})", e.count, looks, e.worst.value, e.worst_step);
    out.push_back(std::move(text));
  }
  return out;
}

}  // namespace moraine
