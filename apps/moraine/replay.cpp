// SPDX-License-Identifier: Apache-2.0
#include "replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "runtime/replay/replay.hpp"
#include "runtime/trace/chrome.hpp"

namespace moraine::app {
namespace {

using runtime::Prediction;
using runtime::ReplayOptions;
using runtime::Workload;

struct Case {
  ReplayOptions options;
  Prediction prediction;
};

template <class Value>
std::vector<Value> chosen(const std::vector<Value>& list, const Value& traced) {
  return list.empty() ? std::vector{traced} : list;
}

ReplayOptions common_options(const ReplayChoices& c, const Workload& work) {
  ReplayOptions o = runtime::as_traced(work);
  if (c.cores >= 0) o.machine.cores = c.cores;
  if (c.latency >= 0) o.machine.latency = c.latency;
  o.machine.bandwidth = c.bandwidth;
  o.machine.speed = c.speed;
  if (c.balance_every > 0) o.balance_every = c.balance_every * work.settings.rounds_per_step;
  o.copies = c.copies;
  return o;
}

std::vector<Case> cases_of(const ReplayChoices& c, const Workload& work) {
  std::vector<Case> cases;
  const runtime::TraceSettings& traced = work.settings;
  ReplayOptions o = common_options(c, work);
  for (const std::string& scheduler : chosen(c.schedulers, traced.scheduler))
    for (const std::string& balancer : chosen(c.balancers, traced.balancer))
      for (const int ranks : chosen(c.ranks, traced.ranks()))
        for (const int threads : chosen(c.threads, traced.threads.empty() ? 1 : traced.threads.front())) {
          o.machine.scheduler = scheduler;
          o.balancer = balancer;
          o.machine.ranks = ranks;
          o.machine.threads = threads;
          cases.push_back({o, {}});
        }
  return cases;
}

std::string layout(const Case& c) {
  return fmt::format("{} x {}, {}, {}", c.options.machine.ranks, c.options.machine.threads, c.options.machine.scheduler,
                     c.options.balancer);
}

void print_one(const Workload& work, const Case& c) {
  const Prediction& p = c.prediction;
  const auto line = [](std::string_view name, const std::string& value) {
    std::cout << fmt::format("{:<16} {}\n", name, value);
  };
  line("layout", layout(c) + (c.options.copies > 1 ? fmt::format(", {} copies", c.options.copies) : ""));
  line("traced", fmt::format("{} x {}, {}, {}: {:.4f} s in {} epochs", work.settings.ranks(),
                             work.settings.threads.empty() ? 1 : work.settings.threads.front(), work.settings.scheduler,
                             work.settings.balancer, work.traced_makespan, work.epochs.size()));
  line("makespan", fmt::format("{:.4f} s: {:.4f} s in tasks, {:.4f} s between epochs, {:.4f} s balancing", p.makespan,
                               p.tasks_span, p.between, p.balancing));
  line("work", fmt::format("{:.4f} s in {} tasks", p.work, p.tasks));
  line("utilisation",
       fmt::format("{:.1f} %; while tasks run {:.1f} %", 100 * p.utilisation, 100 * p.tasks_utilisation));
  line("imbalance", fmt::format("{:.3f} between ranks", p.imbalance));
  line("messages", fmt::format("{:.0f} between ranks, {:.3g} bytes", p.messages, p.bytes));
  line("moves", fmt::format("{} in {} balance rounds, {:.3g} bytes", p.migrations, p.balance_rounds, p.moved_bytes));
}

/// A row per rank count, a column per thread count: how much of what could work does.
void print_grid(const std::vector<Case>& cases) {
  std::set<int> columns;
  for (const Case& c : cases) columns.insert(c.options.machine.threads);
  std::optional<std::string> title;
  int row = 0;
  for (const Case& c : cases) {
    const runtime::Machine& m = c.options.machine;
    const std::string own = m.scheduler + ", " + c.options.balancer;
    if (own != title) {
      std::cout << fmt::format("{}\n{}: efficiency %\n{:>8}", title ? "\n" : "", own, "ranks");
      for (const int threads : columns) std::cout << fmt::format("{:>12}", fmt::format("x {}", threads));
      title = own;
      row = 0;
    }
    if (m.ranks != row) std::cout << fmt::format("\n{:>8}", m.ranks);
    row = m.ranks;
    std::cout << fmt::format("{:>12.1f}", 100 * c.prediction.utilisation);
  }
  std::cout << '\n';
}

void print_list(const std::vector<Case>& cases) {
  std::cout << fmt::format("\n{:>7} {:>7} {:<14} {:<10} {:>12} {:>7} {:>7} {:>9} {:>10} {:>7}\n", "ranks", "threads",
                           "scheduler", "balancer", "makespan s", "eff. %", "tasks %", "imbalance", "messages",
                           "moves");
  for (const Case& c : cases) {
    const Prediction& p = c.prediction;
    std::cout << fmt::format("{:>7} {:>7} {:<14} {:<10} {:>12.4f} {:>7.1f} {:>7.1f} {:>9.3f} {:>10.0f} {:>7}\n",
                             c.options.machine.ranks, c.options.machine.threads, c.options.machine.scheduler,
                             c.options.balancer, p.makespan, 100 * p.utilisation, 100 * p.tasks_utilisation,
                             p.imbalance, p.messages, p.migrations);
  }
}

/// Of layouts within 1 % of the shortest makespan, the shortest with the fewest workers.
const Case& best(const std::vector<Case>& cases) {
  const auto makespan = [](const Case& c) { return c.prediction.makespan; };
  const double near_shortest = 1.01 * makespan(*std::ranges::min_element(cases, {}, makespan));
  const auto rank = [&](const Case& c) {
    return std::tuple(makespan(c) > near_shortest, c.options.machine.workers(), makespan(c));
  };
  return *std::ranges::min_element(cases, {}, rank);
}

nlohmann::ordered_json to_json(const Workload& work, const Case& c) {
  const Prediction& p = c.prediction;
  const runtime::Machine& m = c.options.machine;
  return {{"ranks", m.ranks},
          {"threads_per_rank", m.threads},
          {"cores", m.cores},
          {"scheduler", m.scheduler},
          {"balancer", c.options.balancer},
          {"latency_s", m.latency},
          {"bandwidth_bytes_per_s", m.bandwidth},
          {"copies", c.options.copies},
          {"sub_models", work.sub_models * c.options.copies},
          {"epochs", work.epochs.size()},
          {"traced_makespan_s", work.traced_makespan},
          {"makespan_s", p.makespan},
          {"tasks_span_s", p.tasks_span},
          {"between_epochs_s", p.between},
          {"balancing_s", p.balancing},
          {"work_s", p.work},
          {"tasks", p.tasks},
          {"utilisation", p.utilisation},
          {"tasks_utilisation", p.tasks_utilisation},
          {"imbalance", p.imbalance},
          {"messages", p.messages},
          {"bytes", p.bytes},
          {"migrations", p.migrations},
          {"moved_bytes", p.moved_bytes},
          {"planning_s", p.planning}};
}

void print_json(const Workload& work, const std::vector<Case>& cases) {
  nlohmann::ordered_json all{{"cases", nlohmann::ordered_json::array()}};
  for (const Case& c : cases) all["cases"].push_back(to_json(work, c));
  all["best"] = to_json(work, best(cases));
  std::cout << all.dump(2) << '\n';
}

void print_text(const Workload& work, const std::vector<Case>& cases) {
  if (cases.size() == 1) return print_one(work, cases.front());
  print_grid(cases);
  print_list(cases);
  std::cout << fmt::format("\nbest: {}, {:.4f} s\n", layout(best(cases)), best(cases).prediction.makespan);
}

}  // namespace

void ReplayChoices::add_to(CLI::App& command) {
  command.add_option("trace", trace, "a trace in the compact form")->required();
  command.add_option("--ranks", ranks, "one or several, as 1,2,4")->delimiter(',')->check(CLI::PositiveNumber);
  command.add_option("--threads", threads, "of each rank, one or several")->delimiter(',')->check(CLI::PositiveNumber);
  command.add_option("--scheduler", schedulers, "one or several")->delimiter(',');
  command.add_option("--balancer", balancers, "one or several")->delimiter(',');
  command.add_option("--balance-every", balance_every, "steps between balances")->check(CLI::PositiveNumber);
  command.add_option("--cores", cores, "that all ranks share; 0: one for every thread (default: as traced)")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--latency", latency, "seconds, of a message between ranks")->check(CLI::NonNegativeNumber);
  command.add_option("--bandwidth", bandwidth, "bytes/s that a rank can send")->check(CLI::PositiveNumber);
  command.add_option("--speed", speed, "of cores, relative to the traced ones")->check(CLI::PositiveNumber);
  command.add_option("--scale", copies, "copies of the model, side by side")->check(CLI::PositiveNumber);
  command.add_option("--epochs", epochs, "only so many of the trace")->check(CLI::PositiveNumber);
  command.add_flag("--json", json, "the same for programs");
}

int replay(const ReplayChoices& choices) {
  const Workload work = runtime::workload_of(runtime::read_trace(choices.trace), choices.epochs);
  std::vector<Case> cases = cases_of(choices, work);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases.size() > 1) std::cerr << fmt::format("replay {} of {}: {}\n", i + 1, cases.size(), layout(cases[i]));
    cases[i].prediction = runtime::replay(work, cases[i].options);
  }
  choices.json ? print_json(work, cases) : print_text(work, cases);
  return 0;
}

}  // namespace moraine::app
