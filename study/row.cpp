// SPDX-License-Identifier: Apache-2.0
#include "study/row.hpp"

#include <algorithm>

#include "study/pareto.hpp"

namespace moraine::study {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

double median(std::span<const Record> runs, const char* key) {
  std::vector<double> values;
  for (const Record& r : runs) values.push_back(r.summary.at(key).get<double>());
  return median(std::move(values));
}

void fail(Row& row, int status, const std::string& reason) {
  row.status = status;
  row.reason = reason;
}

void fill(Row& row, std::span<const Record> runs, const Yardstick& yardstick, Seconds seconds) {
  row.wall_s = median(runs, "loop_wall_s");
  row.cpu_s = median(runs, "loop_cpu_s");
  row.setting.coupling = runs.front().summary.at("coupling").get<std::string>();
  row.setting.split = runs.front().summary.at("split").get<std::string>();
  row.setting.sub_models = runs.front().summary.at("sub_models").get<int>();
  const double spent = seconds == Seconds::wall ? row.wall_s : row.cpu_s;
  row.speed = spent > 0 ? runs.front().summary.at("time").get<double>() / spent : 0;
  row.all = yardstick.compare(runs);
  row.counted = yardstick.compare_counted(runs);
  row.error = error_of(row.counted);
  for (const Comparison& c : row.counted)
    if (c.measured.count < row.seeds) fail(row, 3, "its result has no " + c.observable);
}

}  // namespace

bool alike(std::span<const Record> runs) {
  const auto hash = [](const Record& r) { return r.summary.at("state_hash"); };
  return runs.size() > 1 &&
         std::all_of(runs.begin(), runs.end(), [&](const Record& r) { return hash(r) == hash(runs.front()); });
}

Row make_row(const Setting& setting, std::span<const Record> runs, const Yardstick& yardstick, Seconds seconds) {
  Row row;
  row.setting = setting;
  row.command = runs.front().command;
  row.seeds = static_cast<int>(runs.size());
  const auto bad = std::find_if(runs.begin(), runs.end(), [](const Record& r) { return !r.good(); });
  if (bad != runs.end()) {
    fail(row, bad->status, bad->message);
  } else if (alike(runs)) {
    fail(row, 2, seeds_change_nothing);
  } else {
    fill(row, runs, yardstick, seconds);
  }
  return row;
}

std::vector<std::size_t> front_of(std::span<const Row> rows) {
  std::vector<std::size_t> good;
  std::vector<Score> scores;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].good()) continue;
    good.push_back(i);
    scores.push_back({rows[i].speed, rows[i].error.resolved()});
  }
  std::vector<std::size_t> front = pareto_front(scores);
  for (std::size_t& i : front) i = good[i];
  return front;
}

std::optional<std::size_t> fastest(std::span<const Row> rows, double wish, Verdict verdict) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].good() && judge(rows[i].error, wish) == verdict && (!best || rows[i].speed > rows[*best].speed))
      best = i;
  return best;
}

}  // namespace moraine::study
