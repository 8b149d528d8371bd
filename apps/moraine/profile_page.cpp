// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>
#include <unordered_map>

#include "findings.hpp"
#include "page_template.hpp"

namespace moraine::app {
namespace {

using Json = nlohmann::ordered_json;
using runtime::TaskRecord;

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

/// A value of every record, as the page reads it: little-endian, base64.
template <class Value, class Record, class Function>
std::string column(const std::vector<Record>& records, const Function& value) {
  std::vector<Value> values;
  values.reserve(records.size());
  for (const Record& r : records) values.push_back(static_cast<Value>(value(r)));
  return base64(std::as_bytes(std::span(values)));
}

std::string releasers(const std::vector<TaskRecord>& tasks) {
  const runtime::TaskIndex index(tasks);
  return column<std::int32_t>(tasks, [&](const TaskRecord& t) {
    const TaskRecord* by = index.releasing(t);
    return by == nullptr ? -1 : by - tasks.data();
  });
}

Json tasks_of(const runtime::Trace& trace) {
  const auto& tasks = trace.lists.tasks;
  Json out{{"start", column<double>(tasks, [](const TaskRecord& t) { return t.start; })},
           {"length", column<float>(tasks, [](const TaskRecord& t) { return t.seconds(); })},
           {"waited", column<float>(tasks, [](const TaskRecord& t) { return t.start - t.ready; })},
           {"handed", column<float>(tasks, [](const TaskRecord& t) { return t.start - t.handed; })},
           {"sub_model", column<std::uint32_t>(tasks, [](const TaskRecord& t) { return t.sub_model; })},
           {"stage", column<std::uint8_t>(tasks, [](const TaskRecord& t) { return t.stage; })},
           {"round", column<std::int32_t>(tasks, [](const TaskRecord& t) { return t.round; })},
           {"released_by", releasers(tasks)},
           {"bytes_sent", column<std::uint32_t>(tasks, [](const TaskRecord& t) { return t.bytes_sent; })},
           {"bytes_received", column<std::uint32_t>(tasks, [](const TaskRecord& t) { return t.bytes_received; })},
           {"counters", Json::array()}};
  for (std::size_t c = 0; c < trace.settings.counters.size(); ++c)
    out["counters"].push_back(column<std::uint32_t>(tasks, [c](const TaskRecord& t) { return t.counters[c]; }));
  return out;
}

/// Where the tasks of each worker stand; all workers have a row.
Json rows_of(const runtime::Trace& trace) {
  Json rows = Json::array();
  const auto& tasks = trace.lists.tasks;
  auto at = tasks.begin();
  for (int rank = 0; rank < trace.settings.ranks(); ++rank)
    for (int worker = 0; worker < trace.settings.threads[static_cast<std::size_t>(rank)]; ++worker) {
      const auto first = at;
      while (at != tasks.end() && at->rank == rank && at->worker == worker) ++at;
      rows.push_back({{"rank", rank}, {"worker", worker}, {"first", first - tasks.begin()}, {"count", at - first}});
    }
  return rows;
}

Json phases_of(const runtime::Trace& trace) {
  Json out = Json::array();
  for (const runtime::PhaseRecord& p : trace.lists.phases)
    out.push_back({p.start, p.end, runtime::phase_names[static_cast<std::size_t>(p.phase)], p.rank});
  return out;
}

Json epochs_of(const Findings& f) {
  std::unordered_map<std::uint32_t, std::vector<int>> owners;
  for (const runtime::OwnerRecord& o : f.trace.lists.owners) {
    std::vector<int>& of = owners[o.epoch];
    of.resize(static_cast<std::size_t>(f.trace.settings.sub_models));
    of.at(o.sub_model) = o.rank;
  }
  Json out = Json::array();
  for (const runtime::EpochLoad& e : f.profile.epochs)
    out.push_back({{"start", e.start}, {"end", e.end}, {"busy", e.busy}, {"owner", owners[e.epoch]}});
  return out;
}

Json path_of(const Findings& f) {
  using runtime::Segment;
  const std::vector<Segment>& path = f.profile.path.segments;
  const TaskRecord* first = f.trace.lists.tasks.data();
  return {{"start", column<double>(path, [](const Segment& s) { return s.start; })},
          {"end", column<double>(path, [](const Segment& s) { return s.end; })},
          {"on", column<std::uint8_t>(path, [](const Segment& s) { return s.on; })},
          {"task", column<std::int32_t>(path, [first](const Segment& s) { return s.task - first; })}};
}

std::pair<double, double> span_of(const runtime::TraceLists& lists) {
  std::pair span{lists.tasks.front().start, lists.tasks.front().end};
  const auto widen = [&](const auto& r) { span = {std::min(span.first, r.start), std::max(span.second, r.end)}; };
  for (const TaskRecord& t : lists.tasks) widen(t);
  for (const runtime::PhaseRecord& p : lists.phases) widen(p);
  return span;
}

/// No end of a script may stand in it.
std::string embeddable(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at)) text.replace(at, 2, "<\\/");
  return text;
}

}  // namespace

std::string page_of(const Findings& f) {
  const runtime::TraceSettings& s = f.trace.settings;
  const auto [begin, end] = span_of(f.trace.lists);
  const Json data{{"begin", begin},
                  {"end", end},
                  {"ranks", s.ranks()},
                  {"threads", s.threads},
                  {"sub_models", s.sub_models},
                  {"stages", s.stages},
                  {"counters", s.counters},
                  {"rows", rows_of(f.trace)},
                  {"phases", phases_of(f.trace)},
                  {"epochs", epochs_of(f)},
                  {"path", path_of(f)},
                  {"tasks", tasks_of(f.trace)},
                  {"report", json_of(f)}};
  constexpr std::string_view mark = "/*DATA*/";
  std::string page(page_template);
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) throw std::logic_error("the page has no place for data");
  return page.replace(at, mark.size(), embeddable(data));
}

}  // namespace moraine::app
