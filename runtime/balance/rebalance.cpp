// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/rebalance.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include "runtime/migrate/move.hpp"
#include "runtime/records.hpp"

namespace moraine::runtime {
namespace {

using Clock = std::chrono::steady_clock;

template <class Record>
std::vector<Record> joined(const std::vector<Bytes>& parts) {
  std::vector<Record> all;
  for (const Bytes& part : parts) {
    std::span<const std::byte> in(part);
    const auto records = read_records<Record>(in);
    all.insert(all.end(), records.begin(), records.end());
  }
  return all;
}

template <class Record>
std::vector<Record> collected(Transport& transport, const std::vector<Record>& own) {
  Bytes bytes;
  write_records(bytes, own);
  return joined<Record>(transport.all_gather(bytes));
}

/// Both ways of a pair as one, pairs ascending.
std::vector<Traffic> by_pair(std::vector<Traffic> sent) {
  std::sort(sent.begin(), sent.end(), [](const Traffic& x, const Traffic& y) {
    return std::tie(x.a, x.b, x.bytes) < std::tie(y.a, y.b, y.bytes);
  });
  std::vector<Traffic> pairs;
  for (const Traffic& t : sent) {
    if (pairs.empty() || pairs.back().a != t.a || pairs.back().b != t.b)
      pairs.push_back(t);
    else
      pairs.back().bytes += t.bytes;
  }
  return pairs;
}

}  // namespace

Rebalance::Rebalance(const BalanceOptions& options, Transport& transport)
    : options_(options),
      transport_(transport),
      row_(find_balancer(options.balancer)),
      predictor_(find_predictor(options.predictor)),
      balancer_(row_.make(options.more)) {}

void Rebalance::note(Model& model, const Epoch& epoch, const LoadRecord& load, const std::vector<Mail::Sent>& sent) {
  const int stages = static_cast<int>(model.stages().size());
  const auto rounds = static_cast<double>(epoch.rounds);
  costs_.resize(model.size());
  for (SubModelId id = 0; id < model.size(); ++id) {
    if (!model.placement().holds(id)) continue;
    const double seconds = load.processor_of(id);
    double counted = 0;
    for (int stage = 0; stage < stages; ++stage) counted += model.sub_model(id).counted_work(stage);
    Cost& cost = costs_[id];
    cost.id = id;
    cost.load += options_.measured ? seconds : counted * rounds;
    cost.seconds += seconds;
    cost.memory = model.sub_model(id).memory();
    cost.rounds += rounds;
  }
  for (const Mail::Sent& s : sent)
    if (s.message.from != s.message.to)
      traffic_.push_back({std::min(s.message.from, s.message.to), std::max(s.message.from, s.message.to),
                          static_cast<double>(s.bytes) / std::max(1.0, rounds)});
  traffic_ = by_pair(std::move(traffic_));
}

void Rebalance::settle(Model& model, std::int64_t next_round) {
  last_moves_.clear();
  if (transport_.ranks() == 1 || costs_.empty() || next_round < last_round_ + options_.every) return;
  const Clock::time_point begin = Clock::now();
  last_round_ = next_round;
  const Collected all = collect(model);
  const BalanceDecision decision = decide(problem(all, model.placement().owner), *balancer_, row_.forced);
  BalanceRoundRecord record{.round = next_round,
                            .carried_out = decision.worthwhile,
                            .imbalance = measured_imbalance(all.costs, model.placement().owner),
                            .forecast_before = decision.before.imbalance,
                            .forecast_after = decision.after.imbalance,
                            .gain_seconds = decision.gain_seconds,
                            .cost_seconds = decision.cost_seconds,
                            .moves = decision.moves};
  ++turn_;
  if (decision.worthwhile) carry_out(model, decision.plan, record);
  record.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  records_.push_back(record);
}

void Rebalance::carry_out(Model& model, const Owners& plan, BalanceRoundRecord& record) {
  const std::vector<int>& owner = model.placement().owner;
  for (SubModelId id = 0; id < plan.size(); ++id)
    if (plan[id] != owner[id]) last_moves_.push_back({0, id, owner[id], plan[id]});
  const Moved moved = move(model, transport_, plan);
  for (const double bytes : collected(transport_, std::vector{static_cast<double>(moved.bytes)}))
    record.moved_bytes += bytes;
}

Rebalance::Collected Rebalance::collect(Model& model) {
  std::vector<Cost> own;
  for (SubModelId id = 0; id < model.size(); ++id)
    if (model.placement().holds(id)) own.push_back(costs_[id]);
  Collected all{collected(transport_, own), by_pair(collected(transport_, traffic_))};
  std::sort(all.costs.begin(), all.costs.end(), [](const Cost& a, const Cost& b) { return a.id < b.id; });
  histories_.resize(model.size());
  for (const Cost& c : all.costs) histories_[c.id].add(c.load / std::max(1.0, c.rounds));
  costs_.assign(model.size(), {});
  traffic_.clear();
  return all;
}

double Rebalance::measured_imbalance(const std::vector<Cost>& costs, const std::vector<int>& owner) const {
  std::vector<double> busy(static_cast<std::size_t>(transport_.ranks()), 0.0);
  for (const Cost& c : costs) busy[static_cast<std::size_t>(owner[c.id])] += c.seconds;
  const double sum = std::accumulate(busy.begin(), busy.end(), 0.0);
  return sum > 0 ? *std::max_element(busy.begin(), busy.end()) * static_cast<double>(busy.size()) / sum : 1.0;
}

BalanceProblem Rebalance::problem(const Collected& all, const std::vector<int>& owner) const {
  BalanceProblem p;
  for (const Cost& c : all.costs) {
    p.load.push_back(predictor_.predict(histories_[c.id].loads()));
    p.bytes.push_back(c.memory);
  }
  p.traffic = all.traffic;
  p.owner = owner;
  p.speed.assign(static_cast<std::size_t>(transport_.ranks()), 1.0);
  p.turn = turn_;
  p.costs = costs_of(options_.measured, options_.every);
  return p;
}

std::int64_t Rebalance::migrations() const {
  std::int64_t sum = 0;
  for (const BalanceRoundRecord& r : records_) sum += r.carried_out ? r.moves : 0;
  return sum;
}

void Rebalance::save(std::vector<std::byte>& out) const {
  write_records(out, std::vector<std::int64_t>{last_round_, turn_});
  Bytes histories;
  for (const LoadHistory& h : histories_) h.save(histories);
  write_records(out, histories);
}

void Rebalance::load(std::span<const std::byte>& in) {
  const auto counters = read_records<std::int64_t>(in);
  const Bytes histories = read_records<std::byte>(in);
  if (counters.size() != 2 || histories.size() % LoadHistory::saved_bytes != 0)
    throw std::runtime_error("saved loads are malformed");
  last_round_ = counters[0];
  turn_ = counters[1];
  histories_.clear();
  for (std::size_t at = 0; at < histories.size(); at += LoadHistory::saved_bytes)
    histories_.emplace_back().load(std::span(histories).subspan(at, LoadHistory::saved_bytes));
}

}  // namespace moraine::runtime
