// SPDX-License-Identifier: Apache-2.0
// moraine info: what would run, without running it.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "commands.hpp"
#include "ghosting/auto_count.hpp"
#include "ghosting/model.hpp"
#include "output/label.hpp"
#include "runtime/cores.hpp"

namespace moraine::app {
namespace {

void line(const char* what, const std::string& text) { std::cout << fmt::format("{:<16}{}\n", what, text); }

std::string features_text(const Scene& scene) {
  const Features f = features_of(scene);
  std::string used, left_out;
  const auto note = [&](const char* name, bool in_use) {
    std::string& to = in_use ? used : left_out;
    to += (to.empty() ? "" : ", ") + std::string(name);
  };
  note("friction", f.friction);
  note("rotation", f.rotation);
  note("restitution", f.restitution);
  note("bonds", f.bonds);
  note("shapes other than spheres", !f.spheres_only);
  return (used.empty() ? "none" : used) + (left_out.empty() ? "" : "; left out: " + left_out);
}

std::string limits_text(const Scene& scene) {
  const Limits limits = find_limits(scene.run.engine_profile);
  if (limits.elements == SIZE_MAX) return "none";
  return fmt::format(
      "{} shapes and {} contact pairs per sub-model, {} sub-models; {} touching spheres, {:.0f} % of them "
      "kept for ghosts",
      limits.elements, limits.contact_pairs, limits.worlds, limits.packed_spheres(), limits.ghost_reserve * 100);
}

/// Sub-models never share a task, so whole tasks bound what stage-by-stage scheduling can use.
std::string barrier_text(std::size_t parts, int threads) {
  const double rounds = std::ceil(static_cast<double>(parts) / threads);
  return fmt::format("{} thread(s); scheduler barrier could use at most {:.1f} % of them", threads,
                     100 * static_cast<double>(parts) / (rounds * threads));
}

std::string time_limit_text(const Scene& scene, const Engine& engine) {
  const StepLimit limit = engine.step_limit(scene), advice = engine.advised_step(scene);
  std::string text = "none";
  if (!limit.reason.empty()) text = fmt::format("{:.4g} s per substep, set by {}", limit.substep, limit.reason);
  if (!advice.reason.empty()) text += fmt::format("; best up to {:.4g} s, set by {}", advice.substep, advice.reason);
  return text;
}

std::string rest_text(const Scene& scene) {
  const RestLimits limits = rest_limits(world_settings(scene), scene.run.skip_threshold);
  if (!limits.on()) return "nothing is skipped (run.skip_threshold)";
  return fmt::format("sub-models are skipped that have been slower than {:.4g} m/s for {} substeps", limits.speed,
                     limits.rounds);
}

/// A sub-model belongs to one rank, so the rank with most of them bounds what all can use: equal sub-models, any
/// scheduler but barrier.
double whole_ownership(std::size_t parts, int ranks, int threads) {
  const double most = std::ceil(static_cast<double>(parts) / ranks);
  return static_cast<double>(parts) / (ranks * std::max(most, static_cast<double>(threads)));
}

std::string ownership_text(std::size_t parts, int ranks, int threads) {
  const double bound = whole_ownership(parts, ranks, threads);
  std::string text = fmt::format("{} rank(s) x {} thread(s): ownership allows {:.1f} %", ranks, threads, 100 * bound);
  if (bound >= 0.95) return text;
  std::size_t better = parts;
  while (whole_ownership(better, ranks, threads) < 0.95) ++better;
  return text +
         fmt::format("; {} sub-models would allow {:.1f} %", better, 100 * whole_ownership(better, ranks, threads));
}

}  // namespace

int info(const Scene& scene, int ranks) {
  const CoupledModel model(scene);
  std::size_t smallest = SIZE_MAX, largest = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    smallest = std::min(smallest, model.part(i).members().size());
    largest = std::max(largest, model.part(i).members().size());
  }
  const int threads = scene.run.threads > 0 ? scene.run.threads : runtime::usable_cores();
  line("scene", fmt::format("{} ({})", scene.name, scene.source));
  line("elements", grouped(scene.elements.size()));
  line("bonds", grouped(scene.bonds.size()));
  line("boundaries", grouped(scene.boundaries.size()));
  line("features", features_text(scene));
  line("engine",
       fmt::format("{}{}: {}", model.engine().name, scene.run.engine == "auto" ? " (auto)" : "", model.engine().help));
  line("engine limits", limits_text(scene));
  line("sub-models", fmt::format("{} by {}, {} to {} elements each{}", model.size(), model.split().name, smallest,
                                 largest, scene.run.sub_models == 0 ? " (auto)" : ""));
  line("ghosts", model.size() < 2
                     ? std::string("none: one sub-model")
                     : fmt::format("coupling {}; about {:.0f} % expected for compact sub-models of this size",
                                   model.coupling().name, 100 * expected_ghost_share(double(largest))));
  line("time", fmt::format("{} steps of {:.6g} s in {} substep(s), {} iterations each", scene.time.steps, scene.time.dt,
                           scene.time.substeps, scene.run.iterations));
  line("time limit", time_limit_text(scene, model.engine()));
  line("rest", rest_text(scene));
  line("scheduling", fmt::format("{}; {}", scene.run.scheduler, barrier_text(model.size(), threads)));
  line("", ownership_text(model.size(), ranks, threads));
  line("memory", fmt::format("about {:.0f} MB for the worlds", 8e-3 * double(scene.elements.size())));
  for (const std::string& warning : scene.warnings) line("warning", warning);
  return 0;
}

}  // namespace moraine::app
