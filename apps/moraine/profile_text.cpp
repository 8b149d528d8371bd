// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "findings.hpp"

namespace moraine::app {
namespace {

using runtime::Account;
using runtime::Profile;
using runtime::SubModelProfile;

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

std::string head(const Findings& f) {
  const runtime::TraceSettings& s = f.trace.settings;
  return fmt::format(
      "{}: {} ranks x {} threads on {:.4g} cores, {}, {}; {} sub-models, {} epochs, {} tasks in {:.3f} s{}\n",
      s.title.empty() ? "trace" : s.title, s.ranks(), s.threads.empty() ? 1 : s.threads.front(), f.cores(), s.scheduler,
      s.balancer, s.sub_models, f.profile.epochs.size(), f.trace.lists.tasks.size(), f.profile.elapsed,
      f.trace.complete ? "" : " (the run was cut short)");
}

std::string stage_table(const Findings& f) {
  std::string text = fmt::format("\n{:<14}{:>10}{:>9}{:>10}  {:>28}  {:>28}\n{:<14}{:>10}{:>9}{:>10}  {:>28}  {:>28}\n",
                                 "stage", "seconds", "share %", "tasks", "us per task", "seconds per rank", "", "", "",
                                 "", "min / mean / max", "min / mean / max");
  for (std::size_t i = 0; i < f.profile.stages.size(); ++i) {
    const runtime::StageProfile& s = f.profile.stages[i];
    text += fmt::format("{:<14}{:>10.4f}{:>9.1f}{:>10}  {:>8.1f}{:>10.1f}{:>10.1f}  {:>8.4f}{:>10.4f}{:>10.4f}\n",
                        f.trace.settings.stages[i], s.seconds, percent(s.seconds, f.profile.all.busy), s.tasks,
                        1e6 * s.per_task.min, 1e6 * s.per_task.mean, 1e6 * s.per_task.max, s.per_rank.min,
                        s.per_rank.mean, s.per_rank.max);
  }
  return text;
}

std::string account_row(const std::string& name, const Account& a) {
  return fmt::format("{:<14}{:>10.4f}{:>10.1f}{:>12.1f}{:>11.1f}{:>13.1f}{:>10.1f}\n", name, a.total(),
                     100 * a.share(a.busy), 100 * a.share(a.imbalance), 100 * a.share(a.messages),
                     100 * a.share(a.scheduling), 100 * a.share(a.between));
}

std::string rank_table(const Profile& p, std::size_t top) {
  std::string text = fmt::format("\n{:<14}{:>10}{:>10}{:>12}{:>11}{:>13}{:>10}\n", "rank", "seconds", "busy %",
                                 "imbalance %", "messages %", "scheduling %", "between %");
  std::vector<std::size_t> order(p.ranks.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const std::size_t shown = std::min(order.size(), std::max<std::size_t>(top, 8));
  if (shown < order.size())
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t r) { return p.ranks[r].busy; });
  for (std::size_t i = 0; i < shown; ++i) text += account_row(fmt::format("{}", order[i]), p.ranks[order[i]]);
  if (shown < order.size()) text += fmt::format("... and {} ranks less busy\n", order.size() - shown);
  return text + account_row("all", p.all);
}

std::string sub_model_table(const Findings& f, std::size_t top) {
  std::string text = fmt::format("\n{:<14}{:>10}{:>9}{:>14}{:>12}{:>8}", "sub-model", "seconds", "share %",
                                 "waited for %", "on path %", "moves");
  for (const std::string& name : f.trace.settings.counters) text += fmt::format("{:>12}", name);
  text += '\n';
  double awaited = 0;
  for (const SubModelProfile& s : f.profile.sub_models) awaited += s.awaited;
  for (const std::size_t at : f.profile.most(&SubModelProfile::seconds, top)) {
    const SubModelProfile& s = f.profile.sub_models[at];
    text += fmt::format("{:<14}{:>10.4f}{:>9.1f}{:>14.1f}{:>12.1f}{:>8}", s.id, s.seconds,
                        percent(s.seconds, f.profile.all.busy), percent(s.awaited, awaited),
                        percent(s.on_path, f.profile.elapsed), s.moves);
    for (std::size_t c = 0; c < f.trace.settings.counters.size(); ++c) text += fmt::format("{:>12.0f}", s.counters[c]);
    text += '\n';
  }
  return text;
}

std::string wait_table(const Profile& p, std::size_t top) {
  std::string text =
      fmt::format("\n{:<14}{:>14}{:>16}{:>18}\n", "waiting rank", "for rank", "its tasks, s", "its messages, s");
  for (std::size_t i = 0; i < std::min(top, p.waits.size()); ++i)
    text += fmt::format("{:<14}{:>14}{:>16.4f}{:>18.4f}\n", p.waits[i].waiter, p.waits[i].awaited, p.waits[i].tasks,
                        p.waits[i].messages);
  return text;
}

std::string path_text(const Findings& f, std::size_t top) {
  const runtime::CriticalPath& path = f.profile.path;
  const double whole = f.profile.elapsed;
  std::string text = fmt::format(
      "\ncritical path  {:.1f} % of the run in tasks, {:.1f} % messages, {:.1f} % scheduling, {:.1f} % between epochs; "
      "{} times from rank to rank\n  stages      ",
      percent(path.tasks, whole), percent(path.messages, whole), percent(path.scheduling, whole),
      percent(path.between, whole), path.hops);
  for (std::size_t i = 0; i < path.stages.size(); ++i)
    text += fmt::format("{} {} {:.1f} %", i > 0 ? "," : "", f.trace.settings.stages[i], percent(path.stages[i], whole));
  text += "\n  sub-models  ";
  bool first = true;
  for (const std::size_t at : f.profile.most(&SubModelProfile::on_path, top)) {
    text += fmt::format("{} {}: {:.1f} %", first ? "" : ",", f.profile.sub_models[at].id,
                        percent(f.profile.sub_models[at].on_path, whole));
    first = false;
  }
  return text + '\n';
}

std::string other_text(const Findings& f) {
  const runtime::Communication& c = f.profile.communication;
  const runtime::BalanceProfile& b = f.profile.balance;
  double rounds = 0;
  for (const runtime::EpochRecord& e : f.trace.lists.epochs) rounds += static_cast<double>(e.rounds);
  rounds = std::max(1.0, rounds);
  std::string text = fmt::format(
      "messages       {:.1f} per round between {} pairs of sub-models, {:.3g} bytes; {:.1f} of them between ranks, "
      "{:.3g} "
      "bytes, {:.1f} us on their way\n",
      c.messages / rounds, c.pairs, c.bytes / rounds, c.messages_between / rounds, c.bytes_between / rounds,
      1e6 * c.on_their_way);
  text += fmt::format("ghosts         {:.0f} for {:.0f} elements; {:.1f} % of the busy time, by number of bodies\n",
                      f.ghosts.ghosts, f.ghosts.elements, 100 * f.ghosts.share);
  if (b.rounds > 0)
    text += fmt::format(
        "balancing      {} of {} rounds carried out, {} moves, {:.3g} bytes; cost {:.4f} s, gained {:.4f} s of the "
        "mean "
        "rank's work (forecast {:.4f} s)\n",
        b.carried_out, b.rounds, b.moves, b.bytes, b.seconds, b.gain, b.forecast_gain);
  return text + fmt::format("imbalance      {:.3f} busiest rank / mean rank; utilisation {:.1f} %\n",
                            f.profile.imbalance(), 100 * f.profile.utilisation());
}

std::string cure_table(const Findings& f) {
  std::string text = fmt::format("\n{:<44}{:>12}{:>10}{:>12}\n", "replayed with", "makespan s", "gain %", "imbalance");
  text += fmt::format("{:<44}{:>12.4f}{:>10}{:>12.3f}\n", "nothing changed", f.cures.now.makespan, "",
                      f.cures.now.imbalance);
  for (const runtime::Cure& c : f.cures.tried)
    text += fmt::format("{:<44}{:>12.4f}{:>10.1f}{:>12.3f}{}\n", runtime::words(c, f.work), c.prediction.makespan,
                        100 * c.gain, c.prediction.imbalance, c.fits ? "" : "  needs more cores");
  return text;
}

}  // namespace

std::string text_of(const Findings& f, std::size_t top) {
  return head(f) + stage_table(f) + rank_table(f.profile, top) + sub_model_table(f, top) + wait_table(f.profile, top) +
         path_text(f, top) + other_text(f) + cure_table(f) + '\n' + f.sentence + '\n';
}

}  // namespace moraine::app
