// SPDX-License-Identifier: Apache-2.0
#include "findings.hpp"

namespace moraine::app {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const runtime::Range& r) { return {{"min", r.min}, {"mean", r.mean}, {"max", r.max}}; }

Json json_of(const runtime::Account& a) {
  return {{"busy_s", a.busy},         {"imbalance_s", a.imbalance},
          {"messages_s", a.messages}, {"scheduling_s", a.scheduling},
          {"between_s", a.between},   {"utilisation", a.share(a.busy)}};
}

Json stages_of(const Findings& f) {
  Json out;
  for (std::size_t i = 0; i < f.profile.stages.size(); ++i) {
    const runtime::StageProfile& s = f.profile.stages[i];
    out[f.trace.settings.stages[i]] = {{"seconds", s.seconds},
                                       {"tasks", s.tasks},
                                       {"per_task_s", json_of(s.per_task)},
                                       {"per_rank_s", json_of(s.per_rank)},
                                       {"on_path_s", f.profile.path.stages[i]}};
  }
  return out;
}

Json sub_models_of(const Findings& f) {
  Json out = Json::array();
  for (const runtime::SubModelProfile& s : f.profile.sub_models) {
    Json counters;
    for (std::size_t c = 0; c < f.trace.settings.counters.size(); ++c)
      counters[f.trace.settings.counters[c]] = s.counters[c];
    out.push_back({{"id", s.id},
                   {"seconds", s.seconds},
                   {"awaited_s", s.awaited},
                   {"on_path_s", s.on_path},
                   {"moves", s.moves},
                   {"counters", counters}});
  }
  return out;
}

Json waits_of(const runtime::Profile& p) {
  Json out = Json::array();
  for (const runtime::RankWait& w : p.waits)
    out.push_back({{"rank", w.waiter}, {"for", w.awaited}, {"tasks_s", w.tasks}, {"messages_s", w.messages}});
  return out;
}

Json ranks_of(const runtime::Profile& p) {
  Json out = Json::array();
  for (const runtime::Account& a : p.ranks) out.push_back(json_of(a));
  return out;
}

Json tried_of(const Findings& f) {
  Json out = Json::array();
  for (const runtime::Cure& c : f.cures.tried)
    out.push_back({{"change", runtime::words(c, f.work)},
                   {"ranks", c.options.machine.ranks},
                   {"threads_per_rank", c.options.machine.threads},
                   {"scheduler", c.options.machine.scheduler},
                   {"balancer", c.options.balancer},
                   {"sub_models", f.work.sub_models * c.pieces},
                   {"fits", c.fits},
                   {"makespan_s", c.prediction.makespan},
                   {"gain", c.gain}});
  return out;
}

Json setup_of(const Findings& f) {
  const runtime::TraceSettings& s = f.trace.settings;
  return {{"title", s.title},
          {"ranks", s.ranks()},
          {"threads", s.threads},
          {"cores", f.cores()},
          {"scheduler", s.scheduler},
          {"balancer", s.balancer},
          {"sub_models", s.sub_models},
          {"epochs", f.profile.epochs.size()},
          {"tasks", f.trace.lists.tasks.size()},
          {"complete", f.trace.complete},
          {"elapsed_s", f.profile.elapsed}};
}

}  // namespace

nlohmann::ordered_json json_of(const Findings& f) {
  const runtime::CriticalPath& path = f.profile.path;
  const runtime::Communication& c = f.profile.communication;
  const runtime::BalanceProfile& b = f.profile.balance;
  Json out = setup_of(f);
  out["sentence"] = f.sentence;
  out["all"] = json_of(f.profile.all);
  out["imbalance"] = f.profile.imbalance();
  out["ranks_s"] = ranks_of(f.profile);
  out["stages"] = stages_of(f);
  out["sub_models_s"] = sub_models_of(f);
  out["waits"] = waits_of(f.profile);
  out["critical_path"] = {{"tasks_s", path.tasks},     {"messages_s", path.messages}, {"scheduling_s", path.scheduling},
                          {"between_s", path.between}, {"ranks_s", path.ranks},       {"hops", path.hops}};
  out["messages"] = {{"number", c.messages},
                     {"bytes", c.bytes},
                     {"between_ranks", c.messages_between},
                     {"bytes_between_ranks", c.bytes_between},
                     {"pairs", c.pairs},
                     {"on_their_way_s", c.on_their_way}};
  out["ghosts"] = {{"elements", f.ghosts.elements}, {"ghosts", f.ghosts.ghosts}, {"share_of_busy", f.ghosts.share}};
  out["balance"] = {{"rounds", b.rounds},
                    {"carried_out", b.carried_out},
                    {"moves", b.moves},
                    {"bytes", b.bytes},
                    {"cost_s", b.seconds},
                    {"gain_s", b.gain},
                    {"forecast_gain_s", b.forecast_gain}};
  out["culprit"] = f.culprit ? Json{{"sub_model", f.culprit->sub_model},
                                    {"share_of_waiting", f.culprit->share},
                                    {"times_median", f.culprit->times_median}}
                             : Json();
  out["cure"] = f.advice ? Json{{"change", f.advice->words}, {"gain", f.advice->gain}} : Json();
  out["replayed_now_s"] = f.cures.now.makespan;
  out["tried"] = tried_of(f);
  return out;
}

}  // namespace moraine::app
