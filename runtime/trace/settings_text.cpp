// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/settings_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "runtime/trace/trace_file.hpp"

namespace moraine::runtime {
namespace {

/// Calls f(name, member) for every setting.
template <class Settings, class Function>
void each_setting(Settings& s, const Function& f) {
  f("title", s.title);
  f("scheduler", s.scheduler);
  f("balancer", s.balancer);
  f("predictor", s.predictor);
  f("balance_every", s.balance_every);
  f("balance_measured", s.balance_measured);
  f("sub_models", s.sub_models);
  f("rounds_per_step", s.rounds_per_step);
  f("threads", s.threads);
  f("cores", s.cores);
  f("stages", s.stages);
  f("receives", s.receives);
  f("counters", s.counters);
  f("from", s.from);
  f("to", s.to);
  f("every", s.every);
}

}  // namespace

std::string settings_text(const TraceSettings& settings) {
  nlohmann::ordered_json json;
  each_setting(settings, [&](const char* name, const auto& value) { json[name] = value; });
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

TraceSettings read_settings(std::string_view text) {
  TraceSettings settings;
  try {
    const auto json = nlohmann::json::parse(text);
    each_setting(settings, [&](const char* name, auto& value) { json.at(name).get_to(value); });
  } catch (const nlohmann::json::exception& error) {
    throw TraceError(fmt::format("the settings of the trace are malformed: {}", error.what()));
  }
  return settings;
}

}  // namespace moraine::runtime
