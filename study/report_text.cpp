// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "output/label.hpp"
#include "physics/errors.hpp"
#include "study/report.hpp"

namespace moraine::study {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

double number_of(const std::string& text, const std::string& whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError(
        fmt::format("--peer {}: '{}' is no number, expected NAME=SPEED,observable=value,...", whole, text));
  return value;
}

const Yardstick::Mark* find(const std::vector<Yardstick::Mark>& marks, std::string_view name) {
  const auto found =
      std::find_if(marks.begin(), marks.end(), [&](const auto& m) { return m.observable->name == name; });
  return found == marks.end() ? nullptr : &*found;
}

std::string clock_text(const Report& r) {
  return fmt::format("{}, {} at a time on {} cores, {} thread{} each",
                     r.seconds == Seconds::wall ? "wall time" : "processor time", r.at_once, r.cores, r.threads,
                     r.threads > 1 ? "s" : "");
}

std::string value_text(const Sample& s) {
  if (s.count == 0) return fmt::format("{:.5g}", s.mean);
  return s.count > 1 ? fmt::format("{:.5g} ± {:.2g}", s.mean, s.deviation) : fmt::format("{:.5g}", s.mean);
}

std::string marks_table(const Report& r) {
  std::string text = "| observable | | reference, ± one seed | an error of 100 % | counts |\n|---|---|---|---|---|\n";
  for (const Yardstick::Mark& m : r.marks)
    text += fmt::format("| {} | {} | {}{} | {:.4g} {} | {} |\n", m.observable->name, m.observable->help,
                        value_text(m.reference), m.reference.count == 0 ? " exactly" : "", m.scale, m.observable->unit,
                        m.counted ? "yes" : "");
  return text;
}

std::string ratio_text(const Report& r, const Row& row) {
  return r.reference && r.reference->speed > 0 ? fmt::format("{:.3g}", row.speed / r.reference->speed) : "";
}

std::string setting_cells(const Setting& s) {
  return fmt::format("{} | {:.4g} | {} | {} | {}", s.engine, s.dt, s.substeps, s.iterations, s.sub_models);
}

/// What was chosen beside the columns that every table has.
std::string other_choices(const Setting& s) {
  std::string text;
  for (const Choice& c : s.choices) {
    static const std::vector<std::string> columns{"run.engine", "time.dt", "time.substeps", "run.iterations",
                                                  "run.sub_models"};
    if (c.name == limit_share || std::find(columns.begin(), columns.end(), key_of(c.name)) != columns.end()) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", c.name, c.value);
  }
  return text;
}

std::string front_table(const Report& r) {
  std::string text =
      "| | engine | dt, s | substeps | iterations | sub-models | other | simulated s / s | × reference | error | worst "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (std::size_t k = 0; k < r.front.size(); ++k) {
    const Row& row = r.rows[r.front[k]];
    text +=
        fmt::format("| {} | {} | {} | {:.3g} | {} | {} | {} |\n", k + 1, setting_cells(row.setting),
                    other_choices(row.setting), row.speed, ratio_text(r, row), error_text(row.error), row.error.worst);
  }
  return text;
}

std::string speeds_text(const Report& r, const Row& row) {
  std::string text = fmt::format("{:.3g} simulated s / s", row.speed);
  if (r.reference) text += fmt::format(", {} × the reference", ratio_text(r, row));
  for (const Peer& p : r.peers) text += fmt::format(", {:.3g} × {}", row.speed / p.speed, p.name);
  return text;
}

std::string best_text(const Report& r, double wish) {
  std::string text = fmt::format("- below {:g} %: ", 100 * wish);
  const auto sure = fastest(r.rows, wish, Verdict::below);
  if (sure) {
    const Row& row = r.rows[*sure];
    text += fmt::format("{}: {}, {}\n", row.setting.label(), error_text(row.error), speeds_text(r, row));
  } else {
    text += "nothing, as far as these seeds can tell\n";
  }
  const auto perhaps = fastest(r.rows, wish, Verdict::undecided);
  if (!perhaps || (sure && r.rows[*perhaps].speed <= r.rows[*sure].speed)) return text;
  const Row& row = r.rows[*perhaps];
  return text + fmt::format("  - perhaps {}: {}, {}; {}\n", row.setting.label(), error_text(row.error),
                            speeds_text(r, row), seeds_text(seeds_to_decide(row.counted, wish)));
}

std::string failures_text(const Report& r) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const Row& row : r.rows)
    if (!row.good())
      by_reason[fmt::format("{}: {}", row.status == 2 ? "refused" : "failed", row.reason)].push_back(
          row.setting.label());
  std::string text;
  for (const auto& [reason, settings] : by_reason)
    text += fmt::format("- {} ({} such)\n  {}\n", settings.front(), settings.size(), reason);
  return text;
}

std::string peers_text(const Report& r) {
  std::string text;
  for (const Peer& p : r.peers)
    text += fmt::format("- {}: {:.3g} simulated s / s{}\n", p.name, p.speed,
                        p.error() ? fmt::format(", error {:.2g} %", 100 * *p.error()) : "");
  return text;
}

}  // namespace

std::string noise_text(const std::optional<double>& noise) {
  if (!noise) return "One seed says nothing of its own noise.";
  return fmt::format("Its seeds alone make an error of {:.2g} %.", 100 * *noise);
}

std::string seeds_text(const SeedsNeeded& n) {
  std::vector<std::string> ways;
  if (n.of_setting) ways.push_back(fmt::format("{} seeds of it", *n.of_setting));
  if (n.of_both && !(n.of_setting && *n.of_setting <= *n.of_both))
    ways.push_back(fmt::format("{} seeds of it and of the reference", *n.of_both));
  if (ways.empty()) return "no number of seeds is known that would decide";
  return fmt::format("about {} would decide", fmt::join(ways, " or "));
}

std::string error_text(const Error& e) {
  const double uncertainty = e.high - e.value;
  if (!std::isfinite(uncertainty)) return fmt::format("{:.2g} %", 100 * e.value);
  return fmt::format("{:.2g} ± {:.2g} %", 100 * e.value, 100 * uncertainty);
}

std::optional<double> Peer::error() const {
  if (compared.empty()) return std::nullopt;
  return error_of(compared).value;
}

Peer read_peer(const std::string& text) {
  Peer peer;
  for (const std::string& part : split(text, ',')) {
    const auto equals = part.find('=');
    if (equals == std::string::npos)
      throw InputError(fmt::format("--peer {}: expected NAME=SPEED,observable=value,...", text));
    const std::string name = part.substr(0, equals);
    const double value = number_of(part.substr(equals + 1), text);
    if (peer.name.empty()) {
      peer.name = name;
      peer.speed = value;
    } else {
      peer.values.push_back({find_observable(name, "--peer " + text).name, value});
    }
  }
  if (peer.name.empty() || !(peer.speed > 0))
    throw InputError(fmt::format("--peer {}: expected a name and a speed above 0, NAME=SPEED,...", text));
  return peer;
}

void compare(Peer& peer, const Yardstick& yardstick) {
  for (const auto& [name, value] : peer.values)
    if (const Yardstick::Mark* m = find(yardstick.marks(), name); m && m->counted)
      peer.compared.push_back({std::string(name), {1, value, 0}, m->reference, m->scale});
}

std::string front_text(const Report& r) {
  std::string text = fmt::format("# {}: speed against error\n\n", r.scene);
  text += fmt::format("{} elements, {:.4g} s simulated. Seeds: {}. Speeds: {}.\n", grouped(r.elements), r.duration,
                      r.seeds_text, clock_text(r));
  if (r.reference)
    text += fmt::format("Reference: {}, {} seeds, {:.3g} simulated s / s. {}\n", r.reference->setting.label(),
                        r.reference->seeds, r.reference->speed, noise_text(r.noise));
  text += '\n';
  text += marks_table(r);
  text += fmt::format("\n{} settings. Those that no other beats:\n\n{}\n", r.rows.size(), front_table(r));
  for (std::size_t k = 0; k < r.front.size(); ++k) text += fmt::format("{}. `{}`\n", k + 1, r.rows[r.front[k]].command);
  text += "\nThe fastest:\n\n";
  for (const double wish : r.wishes) text += best_text(r, wish);
  if (!r.peers.empty()) text += fmt::format("\nOthers:\n\n{}", peers_text(r));
  if (const std::string failures = failures_text(r); !failures.empty())
    text += fmt::format("\nNot done:\n\n{}", failures);
  return text;
}

}  // namespace moraine::study
