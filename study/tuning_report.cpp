// SPDX-License-Identifier: Apache-2.0
#include "study/tuning_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/label.hpp"
#include "study/report.hpp"

namespace moraine::study {
namespace {

using Json = nlohmann::ordered_json;

std::string speed_text(const TuningReport& r, const Row& row) {
  std::string text = fmt::format("{:.3g} simulated s / s", row.speed);
  if (r.tuned.reference) text += fmt::format(", {:.3g} × the reference", row.speed / r.tuned.reference->speed);
  return text;
}

std::string row_text(const TuningReport& r, const Row& row) {
  if (!row.good()) return fmt::format("- {}: {}\n", row.setting.label(), row.reason);
  return fmt::format("- {}: {} ({}), {} seeds; {}\n", row.setting.label(), error_text(row.error), row.error.worst,
                     row.seeds, speed_text(r, row));
}

std::string undecided_text(const TuningReport& r) {
  std::string text;
  for (const Row& row : r.tuned.undecided)
    text += row_text(r, row) + "  " + seeds_text(seeds_to_decide(row.counted, r.options.wish)) + "\n";
  return text.empty() ? "" : fmt::format("\nUndecided within {} seeds:\n\n{}", r.options.most_seeds, text);
}

std::string too_bad_text(const TuningReport& r) {
  std::string text;
  for (const Row& row : r.tuned.too_bad) text += row_text(r, row);
  return text.empty() ? "" : fmt::format("\nNot good enough:\n\n{}", text);
}

std::string evidence_text(const Row& row) {
  std::string text = "| observable | measured | reference | error |\n|---|---|---|---|\n";
  for (const Comparison& c : row.counted) {
    const Deviation d = deviation(c);
    text +=
        fmt::format("| {} | {:.5g} ± {:.2g} | {:.5g} ± {:.2g} | {:+.2g} ± {:.2g} % |\n", c.observable, c.measured.mean,
                    c.measured.deviation, c.reference.mean, c.reference.deviation, 100 * d.value, 100 * d.uncertainty);
  }
  return text;
}

std::string where_text(const TuningReport& r) {
  if (!r.tuned.on_proxy) return "";
  return fmt::format("Judged on the small scene ({} elements) only; the scene itself was not run.\n",
                     grouped(r.subject->proxy().scene().elements.size()));
}

std::string search_text(const TuningReport& r) {
  const Tuned& t = r.tuned;
  std::string text = fmt::format("{} settings", t.candidates);
  if (r.subject->has_proxy())
    text += fmt::format(" screened on {} elements", grouped(r.subject->proxy().scene().elements.size()));
  text += fmt::format(
      ": {} failed, {} surely too bad; then judged by fresh seeds, cheapest first: {} too bad, {} "
      "undecided.\n",
      t.failed, t.refuted, t.too_bad.size(), t.undecided.size());
  return text + fmt::format("{} runs made in {} ({} of processor time), {} at a time, {} thread{} each.\n", r.runs,
                            duration_label(r.wall_s), duration_label(r.cpu_s), r.at_once, r.threads,
                            r.threads > 1 ? "s" : "");
}

/// What was found, worked out for the scene itself: on a proxy the same choices come to other steps.
Setting of_the_scene(const TuningReport& r) { return r.subject->resolve(r.tuned.found->setting.choices); }

std::string found_text(const TuningReport& r) {
  const Row& row = *r.tuned.found;
  std::string text = fmt::format("Error below {:g} %: **{}**\n", 100 * r.options.wish, row.setting.label());
  text += fmt::format("Error {} (worst: {}) on {} fresh seeds; {}.\n{}\n", error_text(row.error), row.error.worst,
                      row.seeds, speed_text(r, row), where_text(r));
  const Setting found = of_the_scene(r);
  text += evidence_text(row) + "\n```yaml\n" + yaml_text(found.changes) + "```\n\n```sh\n";
  return text + command_line(r.file, r.subject->settings(found)) + "\n```\n";
}

/// The candidate that came nearest.
const Row* nearest(const Tuned& t) {
  const Row* best = nullptr;
  for (const std::vector<Row>* list : {&t.undecided, &t.too_bad})
    for (const Row& row : *list)
      if (row.good() && (!best || row.error.high < best->error.high)) best = &row;
  return best;
}

std::string refusal_text(const TuningReport& r) {
  std::string text = fmt::format("No setting in reach has an error that is surely below {:g} %.\n{}",
                                 100 * r.options.wish, where_text(r));
  if (r.tuned.reference)
    text += fmt::format("Reference: {}. {}\n", r.tuned.reference->setting.label(), noise_text(r.tuned.noise));
  if (const Row* row = nearest(r.tuned)) text += fmt::format("Nearest:\n\n{}", row_text(r, *row));
  return text;
}

Json brief(const Row& row) {
  Json json{{"setting", row.setting.label()}, {"command", row.command}, {"seeds", row.seeds}, {"status", row.status}};
  if (!row.good()) return json;
  json["speed"] = row.speed;
  json["error"] = {{"value", row.error.value}, {"low", row.error.low}, {"high", row.error.high}};
  json["worst"] = row.error.worst;
  return json;
}

Json brief(const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(brief(row));
  return json;
}

}  // namespace

std::string tuning_text(const TuningReport& r) {
  return (r.tuned.found ? found_text(r) : refusal_text(r)) + too_bad_text(r) + undecided_text(r) + "\n" +
         search_text(r);
}

std::string tuning_json(const TuningReport& r) {
  const Tuned& t = r.tuned;
  Json json{{"file", r.file},
            {"wish", r.options.wish},
            {"good_enough", t.found.has_value()},
            {"on_proxy", t.on_proxy},
            {"candidates", t.candidates},
            {"failed", t.failed},
            {"refuted", t.refuted},
            {"noise", t.noise ? Json(*t.noise) : Json()},
            {"runs", r.runs},
            {"wall_s", r.wall_s},
            {"cpu_s", r.cpu_s},
            {"runs_at_once", r.at_once},
            {"too_bad", brief(t.too_bad)},
            {"undecided", brief(t.undecided)}};
  if (t.reference) json["reference"] = brief(*t.reference);
  if (t.found) {
    json["found"] = brief(*t.found);
    const Setting found = of_the_scene(r);
    json["yaml"] = yaml_text(found.changes);
    json["run"] = command_line(r.file, r.subject->settings(found));
  }
  return json.dump(2) + "\n";
}

}  // namespace moraine::study
