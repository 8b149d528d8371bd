// SPDX-License-Identifier: Apache-2.0
// The report for programs: CSV and JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "study/report.hpp"

namespace moraine::study {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Empty unless it is a finite number.
std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.8g}", value) : ""; }

bool on_front(const Report& r, std::size_t row) {
  return std::find(r.front.begin(), r.front.end(), row) != r.front.end();
}

const Comparison* find(const Row& row, std::string_view observable) {
  const auto found =
      std::find_if(row.all.begin(), row.all.end(), [&](const auto& c) { return c.observable == observable; });
  return found == row.all.end() ? nullptr : &*found;
}

std::string header(const Report& r) {
  std::string text =
      "engine,precision,coupling,split,sub_models,dt,steps,substeps,iterations,seeds,status,reason,speed,wall_s,cpu_s,"
      "error,error_low,error_high,worst,front";
  for (const Yardstick::Mark& m : r.marks)
    text += fmt::format(",{0},{0}_sd,{0}_error,{0}_error_uncertainty", m.observable->name);
  return text + ",command\n";
}

std::string observable_cells(const Row& row, const Yardstick::Mark& mark) {
  const Comparison* c = find(row, mark.observable->name);
  if (!c) return ",,,,";
  const Deviation d = deviation(*c);
  return fmt::format(",{},{},{},{}", cell(c->measured.mean), cell(c->measured.deviation), cell(d.value),
                     cell(d.uncertainty));
}

std::string line(const Report& r, const Row& row, bool front) {
  const Setting& s = row.setting;
  std::string text =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},", s.engine, s.precision, s.coupling, s.split, s.sub_models,
                  cell(s.dt), s.steps, s.substeps, s.iterations, row.seeds, row.status, cell(row.reason));
  if (row.good())
    text +=
        fmt::format("{},{},{},{},{},{},{},{}", cell(row.speed), cell(row.wall_s), cell(row.cpu_s),
                    cell(row.error.value), cell(row.error.low), cell(row.error.high), row.error.worst, front ? 1 : 0);
  else
    text += ",,,,,,,0";
  for (const Yardstick::Mark& m : r.marks) text += observable_cells(row, m);
  return text + "," + cell(row.command) + "\n";
}

Json json_of(const Sample& s) { return {{"runs", s.count}, {"mean", s.mean}, {"deviation", s.deviation}}; }

Json json_of(const Error& e) { return {{"value", e.value}, {"low", e.low}, {"high", e.high}, {"worst", e.worst}}; }

Json json_of(const Setting& s) {
  Json choices = Json::object();
  for (const Choice& c : s.choices) choices[c.name] = c.value;
  return {{"engine", s.engine}, {"precision", s.precision},   {"coupling", s.coupling},
          {"split", s.split},   {"sub_models", s.sub_models}, {"dt", s.dt},
          {"steps", s.steps},   {"substeps", s.substeps},     {"iterations", s.iterations},
          {"choices", choices}};
}

Json json_of(const Row& row) {
  Json json = json_of(row.setting);
  json["command"] = row.command;
  json["seeds"] = row.seeds;
  json["status"] = row.status;
  if (!row.good()) {
    json["reason"] = row.reason;
    return json;
  }
  json["speed"] = row.speed;
  json["wall_s"] = row.wall_s;
  json["cpu_s"] = row.cpu_s;
  json["error"] = json_of(row.error);
  for (const Comparison& c : row.all) {
    Json& o = json["observables"][c.observable] = json_of(c.measured);
    const Deviation d = deviation(c);
    o["error"] = d.value;
    o["error_uncertainty"] = d.uncertainty;
  }
  return json;
}

Json json_of(const Yardstick::Mark& m) {
  Json json{{"name", m.observable->name}, {"help", m.observable->help}, {"unit", m.observable->unit},
            {"scale", m.scale},           {"counted", m.counted},       {"exact", m.reference.count == 0}};
  json["reference"] = json_of(m.reference);
  return json;
}

Json json_of(const Peer& p) {
  Json json{{"name", p.name}, {"speed", p.speed}};
  if (p.error()) json["error"] = *p.error();
  return json;
}

Json best_of(const Report& r, double wish) {
  Json json{{"below", wish}};
  if (const auto row = fastest(r.rows, wish, Verdict::below)) {
    json["row"] = *row;
    json["speed"] = r.rows[*row].speed;
    if (r.reference) json["times_reference"] = r.rows[*row].speed / r.reference->speed;
    for (const Peer& p : r.peers) json["times_peer"][p.name] = r.rows[*row].speed / p.speed;
  }
  if (const auto row = fastest(r.rows, wish, Verdict::undecided)) json["undecided_row"] = *row;
  return json;
}

template <class List>
Json list_of(const List& list) {
  Json json = Json::array();
  for (const auto& item : list) json.push_back(json_of(item));
  return json;
}

}  // namespace

std::string csv_text(const Report& r) {
  std::string text = header(r);
  if (r.reference) text += line(r, *r.reference, false);
  for (std::size_t i = 0; i < r.rows.size(); ++i) text += line(r, r.rows[i], on_front(r, i));
  return text;
}

std::string json_text(const Report& r) {
  Json json{{"scene", r.scene},
            {"file", r.file},
            {"command", r.command},
            {"elements", r.elements},
            {"duration", r.duration},
            {"seeds", r.seeds_text},
            {"seconds", r.seconds == Seconds::wall ? "wall" : "processor"},
            {"runs_at_once", r.at_once},
            {"cores", r.cores},
            {"threads", r.threads},
            {"noise", r.noise ? Json(*r.noise) : Json()},
            {"observables", list_of(r.marks)}};
  if (r.reference) json["reference"] = json_of(*r.reference);
  json["rows"] = list_of(r.rows);
  json["front"] = r.front;
  for (const double wish : r.wishes) json["best"].push_back(best_of(r, wish));
  json["peers"] = list_of(r.peers);
  return json.dump(2) + "\n";
}

}  // namespace moraine::study
