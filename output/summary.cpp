// SPDX-License-Identifier: Apache-2.0
#include "output/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "output/file.hpp"
#include "output/label.hpp"

namespace moraine {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Summary::Ghosts& g) {
  return {{"mean", g.mean},
          {"max", g.max},
          {"final", g.final},
          {"fraction_mean", g.fraction_mean},
          {"fraction_final", g.fraction_final}};
}

Json json_of(const Summary::Profile::Share& s) { return {{"min", s.min}, {"mean", s.mean}, {"max", s.max}}; }

Json costliest_of(const Summary::Profile& p) {
  Json out = Json::array();
  for (const auto& c : p.costliest) out.push_back({{"sub_model", c.sub_model}, {"share", c.share}});
  return out;
}

Json json_of(const Summary::Energy& e) {
  return {{"kinetic", e.kinetic},      {"potential", e.potential}, {"bond", e.bond},
          {"contact", e.contact},      {"gained", e.gained},       {"work_of_boundaries", e.work_of_boundaries},
          {"dissipated", e.dissipated}};
}

Json json_of(const Summary::Load& l, const Summary::Profile& p) {
  return {{"imbalance", l.imbalance},
          {"utilisation", l.utilisation},
          {"waiting_fraction", l.waiting_fraction},
          {"migrations", l.migrations},
          {"time",
           {{"busy", json_of(p.busy)},
            {"imbalance", json_of(p.imbalance)},
            {"messages", json_of(p.messages)},
            {"scheduling", json_of(p.scheduling)},
            {"between_epochs", json_of(p.between)}}},
          {"costliest", costliest_of(p)},
          {"cure", p.cure.change.empty() ? Json() : Json{{"change", p.cure.change}, {"gain", p.cure.gain}}},
          {"sentence", p.sentence}};
}

Json json_of(const Summary::Balance::Round& r) {
  return {{"step", r.step},     {"imbalance", r.imbalance}, {"forecast", r.forecast}, {"gain_s", r.gain_s},
          {"cost_s", r.cost_s}, {"moves", r.moves},         {"bytes", r.bytes}};
}

Json json_of(const Summary::Balance& b) {
  Json rounds = Json::array();
  for (const auto& round : b.rounds) rounds.push_back(json_of(round));
  return {{"seconds", b.seconds}, {"moved_bytes", b.moved_bytes}, {"rounds", rounds}};
}

Json json_of(const Summary::Messages& m) {
  return {{"per_round", m.per_round},
          {"bytes_per_round", m.bytes_per_round},
          {"between_ranks", m.between_ranks},
          {"pairs", m.pairs}};
}

Json json_of(const std::map<int, std::array<double, 3>>& quantiles) {
  Json all = Json::object();
  for (const auto& [percent, values] : quantiles) all[std::to_string(percent)] = values;
  return all;
}

Json setup_of(const Summary& s) {
  return {{"scene", s.scene},
          {"engine", s.engine},
          {"precision", s.precision},
          {"coupling", s.coupling},
          {"split", s.split},
          {"scheduler", s.scheduler},
          {"balancer", s.balancer},
          {"ranks", s.ranks},
          {"elements", s.elements},
          {"threads_per_rank", s.threads_per_rank},
          {"steps", s.steps},
          {"sub_models", s.sub_models},
          {"dt", s.dt},
          {"substeps", s.substeps}};
}

Json results_of(const Summary& s) {
  return {{"time", s.time},
          {"wall_s", s.wall_s},
          {"loop_wall_s", s.loop_wall_s},
          {"loop_cpu_s", s.loop_cpu_s},
          {"element_steps_per_s", s.element_steps_per_s},
          {"peak_rss_bytes", s.peak_rss_bytes},
          {"state_hash", s.state_hash},
          {"ghosts", json_of(s.ghosts)},
          {"bonds", {{"total", s.bonds.total}, {"broken", s.bonds.broken}}},
          {"momentum_residual", {{"linear", s.momentum_residual.linear}, {"angular", s.momentum_residual.angular}}},
          {"kinetic_energy", s.kinetic_energy},
          {"energy", json_of(s.energy)},
          {"boundary_force", s.boundary_force},
          {"center_of_mass", s.center_of_mass},
          {"x95", s.x95},
          {"quantiles", json_of(s.quantiles)},
          {"overlap", {{"max", s.overlap.max}, {"mean", s.overlap.mean}}},
          {"coupling_residual", s.coupling_residual},
          {"load", json_of(s.load, s.profile)},
          {"balance", json_of(s.balance)},
          {"messages", json_of(s.messages)},
          {"step_share", s.step_share},
          {"rested", s.rested},
          {"recuts", s.recuts},
          {"warnings", s.warnings}};
}

std::string row(const char* name, const std::string& value) { return fmt::format("  {:<11} {}\n", name, value); }

std::string ghosts_text(const Summary::Ghosts& g) {
  return fmt::format("{:.0f} on average ({:.1f} % of the elements), {} at the end", g.mean, 100 * g.fraction_mean,
                     grouped(g.final));
}

std::string load_text(const Summary::Load& l) {
  return fmt::format("{:.0f} % of the threads' time at work, imbalance {:.2f}, {:.0f} % waiting, {} migrations",
                     100 * l.utilisation, l.imbalance, 100 * l.waiting_fraction, l.migrations);
}

/// A small table: what became of the time of workers, over ranks.
std::string time_text(const Summary::Profile& p) {
  std::string text = fmt::format("  {:<11} {:<16}{:>7}{:>8}{:>8}\n", "time %", "of ranks", "min", "mean", "max");
  const auto line = [&](const char* name, const Summary::Profile::Share& s) {
    text += fmt::format("  {:<11} {:<16}{:>7.1f}{:>8.1f}{:>8.1f}\n", "", name, 100 * s.min, 100 * s.mean, 100 * s.max);
  };
  line("at tasks", p.busy);
  line("imbalance", p.imbalance);
  line("messages", p.messages);
  line("scheduling", p.scheduling);
  line("between epochs", p.between);
  return text;
}

std::string costliest_text(const Summary::Profile& p) {
  std::string text;
  for (const auto& c : p.costliest)
    text += fmt::format("{}sub-model {}: {:.1f} % of the work", text.empty() ? "" : ", ", c.sub_model, 100 * c.share);
  return text;
}

std::string stages_text(const std::map<std::string, double>& shares) {
  std::vector<std::pair<std::string, double>> stages(shares.begin(), shares.end());
  std::stable_sort(stages.begin(), stages.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, share] : stages) {
    text += fmt::format("{}{} {:.1f} %", text.empty() ? "" : ", ", name, 100 * share);
  }
  return text;
}

std::string setup_text(const Summary& s) {
  return fmt::format("{} elements in {} sub-models by {}, {} {}, {}", grouped(s.elements), s.sub_models, s.split,
                     s.engine, s.precision, s.coupling);
}

std::string runtime_text(const Summary& s) {
  return fmt::format("{} ranks x {} threads, scheduler {}, balancer {}", s.ranks, s.threads_per_rank, s.scheduler,
                     s.balancer);
}

std::string speed_text(const Summary& s) {
  return fmt::format("{} steps x {} in {:.3g} s: {:.3g} million element-steps/s, {:.0f} MiB", s.steps, s.substeps,
                     s.loop_wall_s, s.element_steps_per_s / 1e6, s.peak_rss_bytes / 1048576.0);
}

std::string errors_text(const Summary& s) {
  return fmt::format("overlap {:.2g} at most, {:.2g} on average; momentum {:.1e}, angular {:.1e}; coupling {:.1e}",
                     s.overlap.max, s.overlap.mean, s.momentum_residual.linear, s.momentum_residual.angular,
                     s.coupling_residual);
}

}  // namespace

void write_summary(const Summary& summary, const std::filesystem::path& path) {
  Json json = setup_of(summary);
  json.update(results_of(summary));
  replace_file(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string summary_text(const Summary& s) {
  std::string text = s.scene + "\n" + row("model", setup_text(s)) + row("runtime", runtime_text(s)) +
                     row("speed", speed_text(s)) + row("load", load_text(s.load));
  if (!s.step_share.empty()) text += row("stages", stages_text(s.step_share));
  text += row("ghosts", ghosts_text(s.ghosts));
  if (s.bonds.total) text += row("bonds", fmt::format("{} of {} broken", s.bonds.broken, s.bonds.total));
  text += row("errors", errors_text(s)) + row("state hash", s.state_hash);
  if (!s.profile.sentence.empty())
    text += time_text(s.profile) + row("costliest", costliest_text(s.profile)) + row("profile", s.profile.sentence);
  for (const std::string& warning : s.warnings) text += row("warning", warning);
  return text;
}

double quantile(std::span<const ElementState> bodies, int axis, double share) {
  if (bodies.empty()) return 0;
  std::vector<double> x;
  for (const ElementState& s : bodies) x.push_back(s.pose.position[axis]);
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(x.size())));
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, x.size()) - 1);
  std::nth_element(x.begin(), at, x.end());
  return *at;
}

}  // namespace moraine
