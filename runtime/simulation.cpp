// SPDX-License-Identifier: Apache-2.0
#include "runtime/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "runtime/agreement.hpp"
#include "runtime/balance/initial_owners.hpp"
#include "runtime/cores.hpp"
#include "runtime/records.hpp"
#include "runtime/schedule/registry.hpp"

namespace moraine::runtime {
namespace {

Transport& chosen(Transport* transport) { return transport ? *transport : alone(); }

template <class Value>
std::vector<Value> over_ranks(Transport& transport, Value own) {
  Bytes told;
  write_records(told, std::vector{own});
  std::vector<Value> all;
  for (const Bytes& bytes : transport.all_gather(told)) {
    std::span<const std::byte> in(bytes);
    all.push_back(read_records<Value>(in).at(0));
  }
  return all;
}

int threads_of(const Options& options, Transport& transport) {
  return options.threads == 0 ? threads_for(transport) : options.threads;
}

/// Models of one rank hold everything; others may have been placed by their maker.
void place_if_new(Model& model, const Transport& transport) {
  if (!model.placement().owner.empty()) return;
  const std::vector<double> load(model.size(), 1.0), speed(static_cast<std::size_t>(transport.ranks()), 1.0);
  model.place({transport.rank(), initial_owners(load, speed)});
}

}  // namespace

Simulation::Simulation(Model& model, const Options& options, Hooks hooks)
    : model_(model),
      options_(options),
      hooks_(std::move(hooks)),
      transport_(chosen(options.transport)),
      clock_(transport_),
      phases_(clock_),
      executor_(threads_of(options, transport_), find_scheduler(options.scheduler).make(),
                {.clock = clock_,
                 .processor_time = options.processor_time && transport_.ranks() > 1,
                 .shared_cores = threads_of(options, transport_) * transport_.ranks_on_these_cores() > usable_cores()}),
      mail_(transport_, options.check_messages, clock_),
      balance_(options.balance, transport_),
      checkpoints_(options.checkpoint, transport_) {
  place_if_new(model_, transport_);
  if (!options_.trace.file.empty()) recorder_.emplace(options_.trace, settings(), transport_, executor_.workers());
}

TraceSettings Simulation::settings() const {
  TraceSettings s{
      .title = options_.trace.title,
      .scheduler = options_.scheduler,
      .balancer = options_.balance.balancer,
      .predictor = options_.balance.predictor,
      .balance_every = options_.balance.every,
      .balance_measured = options_.balance.measured,
      .sub_models = static_cast<std::int64_t>(model_.size()),
      .rounds_per_step = options_.trace.rounds_per_step,
      .threads = over_ranks(transport_, executor_.workers()),
      .cores = over_ranks(transport_, usable_cores() / static_cast<double>(transport_.ranks_on_these_cores())),
      .stages = {},
      .receives = {},
      .counters = {},
      .from = options_.trace.from,
      .to = options_.trace.to,
      .every = options_.trace.every};
  for (const Stage& stage : model_.stages()) {
    s.stages.emplace_back(stage.name);
    s.receives.push_back(stage.receives);
  }
  for (const std::string_view name : model_.counters()) s.counters.emplace_back(name);
  return s;
}

std::int64_t Simulation::restore(const std::filesystem::path& folder) {
  const std::int64_t next_round = checkpoints_.restore(folder, model_, balance_);
  last_ = {};
  return next_round;
}

void Simulation::run(std::int64_t first_round, std::int64_t rounds) {
  const std::int64_t end = first_round + rounds;
  for (std::int64_t next = first_round; next < end;) {
    phases_.enter(Phase::settle);
    const auto [epoch, fresh] = next_epoch(next, end - next);
    if (recorder_) recorder_->begin_epoch(epoch);
    if (fresh) settle(next);
    run_epoch(epoch);
    next += epoch.rounds;
    phases_.enter(Phase::output);
    if (hooks_.at_epoch_end) hooks_.at_epoch_end(next);
    end_epoch(epoch);
  }
  checkpoints_.finish();
  if (recorder_) recorder_->finish();
}

void Simulation::end_epoch(const Epoch& epoch) {
  phases_.leave();
  std::vector<PhaseRecord> phases = phases_.take();
  if (recorder_) recorder_->end_epoch(std::move(phases), epoch);
}

Simulation::NextEpoch Simulation::next_epoch(std::int64_t next_round, std::int64_t left) {
  const std::int64_t stop = hooks_.until_next_stop ? hooks_.until_next_stop(next_round) : left;
  if (stop < 1) throw std::logic_error(fmt::format("no round may pass from round {} to the next stop", next_round));
  const std::int64_t at_most = std::min(left, stop);
  const EpochPlan plan = model_.begin_epoch(next_round, at_most);
  if (plan.rounds < 1 || plan.rounds > at_most)
    throw std::logic_error(fmt::format("an epoch of {} rounds, expected 1 to {}", plan.rounds, at_most));
  return {{next_round, plan.rounds}, plan.fresh};
}

/// Neighbours are settled and nothing runs: sub-models may move and be saved.
void Simulation::settle(std::int64_t next_round) {
  phases_.enter(Phase::balance);
  const std::size_t before = balance_.records().size();
  balance_.settle(model_, next_round);
  if (recorder_ && balance_.records().size() > before)
    recorder_->balanced(balance_.records().back(), balance_.last_moves());
  phases_.enter(Phase::checkpoint);
  checkpoints_.settle(model_, balance_, next_round);
}

void Simulation::run_epoch(const Epoch& epoch) {
  phases_.enter(Phase::plan);
  const StepGraph graph = predicted_graph();
  mail_.begin_epoch(model_, epoch);
  if (recorder_) recorder_->plan(model_, graph, epoch);
  phases_.enter(Phase::work);
  const std::optional<RunError> error = attempt(graph, epoch);
  phases_.enter(Phase::agree);
  const std::optional<RunError> first = first_failure(transport_, error);
  if (first) {
    transport_.drop_parcels();
    if (recorder_) recorder_->flush();
    throw RunError(*first);
  }
  phases_.enter(Phase::balance);
  load_.merge(last_);
  mail_.close_epoch();
  rounds_ += epoch.rounds;
  const std::vector<Mail::Sent> sent = mail_.sent();
  balance_.note(model_, epoch, last_, sent);
  if (recorder_) recorder_->sent(sent);
}

/// The failure of this rank, if it failed. If another did, this one stops as well.
std::optional<RunError> Simulation::attempt(const StepGraph& graph, const Epoch& epoch) {
  try {
    TaskObserver* observer = recorder_ && recorder_->recording() ? &*recorder_ : nullptr;
    last_ = executor_.run(
        graph, epoch, [&](Task task, int worker) { run_task(graph, epoch, task, worker); }, observer,
        [&](std::vector<Arrival>& arrived) { mail_.poll(graph, arrived); });
  } catch (const RunError& error) {
    tell_others();
    Failure failure = error.failure();
    failure.rank = transport_.rank();
    failure.status = options_.status_of(error.cause());
    return RunError(std::move(failure), error.cause());
  } catch (const FailedElsewhere&) {
  }
  return std::nullopt;
}

StepGraph Simulation::predicted_graph() {
  StepGraph graph = build_step_graph(model_);
  if (options_.measured_cost && last_.busy() > 0) graph.cost = last_.mean_cost(graph);
  return graph;
}

void Simulation::run_task(const StepGraph& graph, const Epoch& epoch, Task task, int worker) {
  const SubModelId id = graph.sub_model(task.node);
  const int stage = graph.stage(task.node);
  Port& port = mail_.open(id, stage, task.round);
  model_.sub_model(id).run(stage, epoch.round(task.round), port);
  const Mail::Carried carried = mail_.close(id);
  if (recorder_ && recorder_->recording()) note_task(id, worker, carried);
}

void Simulation::note_task(SubModelId id, int worker, const Mail::Carried& carried) {
  Recorder::Carried what{carried};
  model_.sub_model(id).count(what.counters);
  recorder_->carried(worker, what);
}

void Simulation::tell_others() {
  for (int rank = 0; rank < transport_.ranks(); ++rank)
    if (rank != transport_.rank()) transport_.send(rank, pack_failure());
}

int threads_for(Transport& transport) { return std::max(1, usable_cores() / transport.ranks_on_these_cores()); }

}  // namespace moraine::runtime
