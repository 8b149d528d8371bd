// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/chrome.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <unordered_map>

#include "runtime/trace/settings_text.hpp"
#include "runtime/trace/task_index.hpp"

namespace moraine::runtime {
namespace {

using Json = nlohmann::json;

double microseconds(double seconds) { return seconds * 1e6; }

std::string quoted(const std::string& text) { return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string stage_name(const TraceSettings& settings, std::int16_t stage) {
  const auto at = static_cast<std::size_t>(stage);
  return at < settings.stages.size() ? settings.stages[at] : fmt::format("stage {}", stage);
}

/// Phases stand in a row of their own, below the workers.
constexpr int phase_row = 100'000;

// Each calls f(name, member) for what a task's arguments and the other lists hold.

template <class Record, class Function>
void each_argument(Record& t, const Function& f) {
  f("round", t.round);
  f("in_epoch", t.in_epoch);
  f("epoch", t.epoch);
  f("sub_model", t.sub_model);
  f("sent", t.sent);
  f("ready", t.ready);
  f("handed", t.handed);
  f("release", t.release);
  f("released_by", t.released_by);
  f("released_stage", t.released_stage);
  f("released_before", t.released_before);
  f("bytes_sent", t.bytes_sent);
  f("bytes_received", t.bytes_received);
  f("counters", t.counters);
  f("stage", t.stage);
  f("processor", t.processor);
}
template <class Record, class Function>
void each_member(const EpochRecord*, Record& r, const Function& f) {
  f(r.first_round), f(r.rounds), f(r.epoch);
}
template <class Record, class Function>
void each_member(const OwnerRecord*, Record& r, const Function& f) {
  f(r.epoch), f(r.sub_model), f(r.rank), f(r.memory);
}
template <class Record, class Function>
void each_member(const CostRecord*, Record& r, const Function& f) {
  f(r.epoch), f(r.sub_model), f(r.stage), f(r.cost);
}
template <class Record, class Function>
void each_member(const MessageRecord*, Record& r, const Function& f) {
  f(r.epoch), f(r.from), f(r.to), f(r.sent_in), f(r.read_in), f(r.messages), f(r.bytes);
}
template <class Record, class Function>
void each_member(const BalanceRoundRecord*, Record& r, const Function& f) {
  f(r.round), f(r.epoch), f(r.carried_out), f(r.imbalance), f(r.forecast_before), f(r.forecast_after);
  f(r.gain_seconds), f(r.cost_seconds), f(r.moves), f(r.moved_bytes), f(r.seconds);
}
template <class Record, class Function>
void each_member(const MoveRecord*, Record& r, const Function& f) {
  f(r.epoch), f(r.sub_model), f(r.from), f(r.to);
}

/// Calls f(name, list) for the lists that are not events.
template <class Lists, class Function>
void each_table(Lists& lists, const Function& f) {
  f("epochs", lists.epochs);
  f("owners", lists.owners);
  f("costs", lists.costs);
  f("messages", lists.messages);
  f("balance", lists.balance);
  f("moves", lists.moves);
}

template <class Record>
Json rows(const std::vector<Record>& list) {
  Json out = Json::array();
  for (const Record& r : list) {
    Json row = Json::array();
    each_member(static_cast<const Record*>(nullptr), r, [&](const auto& value) { row.push_back(value); });
    out.push_back(std::move(row));
  }
  return out;
}

template <class Record>
void read_rows(const Json& json, std::vector<Record>& list) {
  for (const Json& row : json) {
    std::size_t i = 0;
    each_member(static_cast<const Record*>(nullptr), list.emplace_back(),
                [&](auto& value) { row.at(i++).get_to(value); });
  }
}

class Writer {
 public:
  Writer(const Trace& trace, const std::filesystem::path& file)
      : trace_(trace), index_(trace.lists.tasks), path_(file), out_(file) {}

  /// A failed write makes the stream refuse all that follow, so that one look at the end is enough.
  void write() {
    print("{{\"displayTimeUnit\":\"ms\",\"moraine\":{},\n\"traceEvents\":[\n", rest().dump());
    names();
    for (const PhaseRecord& p : trace_.lists.phases) phase(p);
    for (const TaskRecord& t : trace_.lists.tasks) task(t);
    print("\n]}}\n");
    out_.close();
    if (!out_) throw std::runtime_error(fmt::format("{}: cannot write the trace", path_.string()));
  }

 private:
  Json rest() const {
    Json json{{"settings", Json::parse(settings_text(trace_.settings))}, {"complete", trace_.complete}};
    each_table(trace_.lists, [&](const char* name, const auto& list) { json[name] = rows(list); });
    return json;
  }

  template <class... Values>
  void print(fmt::format_string<Values...> text, Values&&... values) {
    out_ << fmt::format(text, std::forward<Values>(values)...);
  }

  template <class... Values>
  void event(fmt::format_string<Values...> text, Values&&... values) {
    out_ << (first_ ? "" : ",\n");
    first_ = false;
    print(text, std::forward<Values>(values)...);
  }

  void name_row(int rank, int row, const std::string& name) {
    event(R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":{}}}}})", rank, row, quoted(name));
  }

  void names() {
    for (int rank = 0; rank < trace_.settings.ranks(); ++rank) {
      event(R"({{"ph":"M","name":"process_name","pid":{},"args":{{"name":"rank {}"}}}})", rank, rank);
      for (int w = 0; w < trace_.settings.threads[static_cast<std::size_t>(rank)]; ++w)
        name_row(rank, w, fmt::format("worker {}", w));
      name_row(rank, phase_row, "epochs");
    }
  }

  void phase(const PhaseRecord& p) {
    event(
        R"({{"ph":"X","cat":"phase","name":"{}","pid":{},"tid":{},"ts":{:.3f},"dur":{:.3f},"args":{{"epoch":{},"phase":{},"processor":{}}}}})",
        phase_names[static_cast<std::size_t>(p.phase)], p.rank, phase_row, microseconds(p.start),
        microseconds(p.seconds()), p.epoch, static_cast<int>(p.phase), p.processor);
  }

  void task(const TaskRecord& t) {
    Json arguments;
    each_argument(t, [&](const char* name, const auto& value) { arguments[name] = value; });
    event(R"({{"ph":"X","cat":"task","name":{},"pid":{},"tid":{},"ts":{:.3f},"dur":{:.3f},"args":{}}})",
          quoted(fmt::format("{} {}", stage_name(trace_.settings, t.stage), t.sub_model)), t.rank, t.worker,
          microseconds(t.start), microseconds(t.seconds()), arguments.dump());
    if (const TaskRecord* by = index_.releasing(t)) arrow(*by, t);
  }

  void arrow(const TaskRecord& by, const TaskRecord& t) {
    ++arrows_;
    event(R"({{"ph":"s","cat":"release","name":"release","id":{},"pid":{},"tid":{},"ts":{:.3f}}})", arrows_, by.rank,
          by.worker, microseconds(by.end));
    event(R"({{"ph":"f","bp":"e","cat":"release","name":"release","id":{},"pid":{},"tid":{},"ts":{:.3f}}})", arrows_,
          t.rank, t.worker, microseconds(t.start));
  }

  const Trace& trace_;
  TaskIndex index_;
  std::filesystem::path path_;
  std::ofstream out_;
  bool first_ = true;
  std::size_t arrows_ = 0;
};

void read_event(const Json& event, TraceLists& lists) {
  if (event.at("ph") != "X") return;
  const double start = event.at("ts").get<double>() / 1e6, end = start + event.at("dur").get<double>() / 1e6;
  const Json& arguments = event.at("args");
  if (event.at("cat") == "phase") {
    lists.phases.push_back({start, end, arguments.at("epoch").get<std::uint32_t>(), event.at("pid").get<int>(),
                            static_cast<Phase>(arguments.at("phase").get<int>()),
                            arguments.at("processor").get<float>()});
    return;
  }
  TaskRecord& t = lists.tasks.emplace_back();
  t.start = start;
  t.end = end;
  t.rank = event.at("pid");
  t.worker = event.at("tid");
  each_argument(t, [&](const char* name, auto& value) { arguments.at(name).get_to(value); });
}

}  // namespace

bool is_chrome_file(const std::filesystem::path& file) { return file.extension() == ".json"; }

void write_chrome(const Trace& trace, const std::filesystem::path& file) { Writer(trace, file).write(); }

Trace read_chrome(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw TraceError(fmt::format("{}: cannot be read", file.string()));
  Trace trace;
  try {
    const Json json = Json::parse(in);
    const Json& rest = json.at("moraine");
    trace.settings = read_settings(rest.at("settings").dump());
    rest.at("complete").get_to(trace.complete);
    each_table(trace.lists, [&](const char* name, auto& list) { read_rows(rest.at(name), list); });
    for (const Json& event : json.at("traceEvents")) read_event(event, trace.lists);
  } catch (const nlohmann::json::exception& error) {
    throw TraceError(
        fmt::format("{}: is not a trace that 'moraine run --trace' wrote: {}", file.string(), error.what()));
  }
  sort(trace.lists);
  return trace;
}

Trace read_trace(const std::filesystem::path& file) {
  return is_chrome_file(file) ? read_chrome(file) : read_trace_file(file);
}

}  // namespace moraine::runtime
