// SPDX-License-Identifier: Apache-2.0
// What would help runs of which it is known.
#include "runtime/profile/cure.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/replay/rearrange.hpp"
#include "runtime/sub_model.hpp"

namespace moraine::runtime {
namespace {

/// Sub-models in a row that each wait for their neighbours of the round before; ten rounds a second each, and as many
/// epochs.
Workload row(std::vector<double> seconds, int ranks, int threads, std::size_t epochs = 6) {
  Workload w;
  w.sub_models = seconds.size();
  w.settings.sub_models = static_cast<std::int64_t>(seconds.size());
  w.settings.stages = {"move"};
  w.settings.receives = {0};
  w.settings.scheduler = "hybrid";
  w.settings.balancer = "none";
  w.settings.predictor = "median";
  w.settings.threads.assign(static_cast<std::size_t>(ranks), threads);
  WorkEpoch e;
  e.span = {0, 9};
  for (const double s : seconds) {
    e.cost.push_back(1e6 * s);
    e.memory.push_back(0);
    e.owner.push_back(static_cast<int>(e.owner.size()) * ranks / static_cast<int>(seconds.size()));
  }
  for (int round = 0; round <= 9; ++round) e.seconds.insert(e.seconds.end(), seconds.begin(), seconds.end());
  for (SubModelId s = 0; s + 1 < seconds.size(); ++s) {
    e.messages.push_back({{s, 0, s + 1, 0}, 8});
    e.messages.push_back({{s + 1, 0, s, 0}, 8});
  }
  std::ranges::sort(e.messages, {}, &SizedMessage::message);
  for (; w.epochs.size() < epochs; e.span.first_round += 9) w.epochs.push_back(e);
  return w;
}

CureSearch on_cores(const Workload& w, double cores, double halo = 0) {
  return {.cores = cores, .halo = std::vector<double>(w.sub_models, halo)};
}

const Cure& best(const Cures& cures) { return cures.tried.at(cures.best.value()); }

TEST(Cures, ABalancerForRanksOfDifferentLoad) {
  const Workload w = row({10, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, 2, 1);
  const Cures cures = find_cures(w, on_cores(w, 1));  // threads instead of ranks would do as well
  EXPECT_EQ(best(cures).change, Change::balancer);
  EXPECT_GT(best(cures).gain, 0.2);
  EXPECT_LT(best(cures).gain, 1 - 10.0 / 15) << "the first epoch is as it was";
}

TEST(Cures, AFinerCutForASubModelThatAllWaitFor) {
  const Workload w = row({8, 1, 1}, 1, 2);
  const Cures cures = find_cures(w, on_cores(w, 2));
  EXPECT_EQ(best(cures).change, Change::finer_cut);
  EXPECT_NEAR(best(cures).gain, 1 - 5.0 / 8, 0.05);
  EXPECT_EQ(words(best(cures), w), "--sub-models " + std::to_string(3 * best(cures).pieces));
}

TEST(Cures, AFinerCutThatPaysForItsGhostsAlone) {
  const Workload w = row({8, 1, 1}, 1, 2);
  const Cures free = find_cures(w, on_cores(w, 2)), dear = find_cures(w, on_cores(w, 2, 0.9));
  EXPECT_FALSE(dear.best);
  EXPECT_GT(best(free).gain, 0.3);
}

TEST(Cures, AnotherSchedulerForBarriers) {
  Workload w = row({1, 1, 1}, 1, 2);
  w.settings.scheduler = "barrier";
  const Cures cures = find_cures(w, on_cores(w, 2));
  EXPECT_EQ(best(cures).change, Change::scheduler);
  EXPECT_NEAR(best(cures).gain, 0.25, 0.06);
}

TEST(Cures, MoreThreadsWhereCoresAreIdle) {
  const Workload w = row({1, 1, 1, 1, 1, 1, 1, 1}, 1, 1);
  const Cures idle = find_cures(w, on_cores(w, 4)), full = find_cures(w, on_cores(w, 1));
  EXPECT_EQ(words(best(idle), w), "1 rank x 4 threads");
  EXPECT_NEAR(best(idle).gain, 0.75, 0.03);
  EXPECT_FALSE(full.best) << "others do not fit";
}

TEST(Cures, LessOutputWhereItTakesTheTime) {
  Workload w = row({1, 1}, 1, 2);
  for (WorkEpoch& e : w.epochs) e.between.phase[static_cast<std::size_t>(Phase::output)] = 10;
  w.traced_makespan = 6 * 20;
  const Cures cures = find_cures(w, on_cores(w, 2));
  EXPECT_EQ(best(cures).change, Change::less_output);
  EXPECT_NEAR(best(cures).gain, 0.375, 1e-9);
}

TEST(Cures, NoneIfNothingWaits) {
  const Workload w = row({1, 1}, 1, 1);
  EXPECT_FALSE(find_cures(w, on_cores(w, 1)).best);
}

TEST(FinerCut, KeepsTheWorkAndCountsGhosts) {
  const Workload w = row({8, 2, 4}, 2, 1, 1);
  const Workload free = cut_finer(w, 4, std::vector<double>(3, 0.0));
  EXPECT_EQ(free.sub_models, 12U);
  EXPECT_NEAR(free.seconds(), w.seconds(), 1e-9);
  EXPECT_DOUBLE_EQ(free.epochs[0].seconds[0], 2);
  EXPECT_DOUBLE_EQ(free.epochs[0].seconds[11], 1);
  EXPECT_EQ(free.epochs[0].owner[3], w.epochs[0].owner[0]);
  const Workload dear = cut_finer(w, 4, std::vector<double>(3, 0.1));
  EXPECT_NEAR(dear.seconds(), w.seconds() * (0.9 + 4 * 0.1), 1e-9) << "a row: the cuts are as large as before";
}

TEST(FinerCut, ARowStaysARow) {
  const Workload w = cut_finer(row({1, 1, 1}, 1, 1, 1), 2, std::vector<double>(3, 0.0));
  const Workload whole = row({1, 1, 1, 1, 1, 1}, 1, 1, 1);
  ASSERT_EQ(w.epochs[0].messages.size(), whole.epochs[0].messages.size());
  for (std::size_t i = 0; i < w.epochs[0].messages.size(); ++i)
    EXPECT_EQ(w.epochs[0].messages[i].message, whole.epochs[0].messages[i].message);
}

TEST(FinerCut, OneSubModelGetsNeighbours) {
  const Workload w = cut_finer(row({8}, 1, 2, 1), 4, std::vector<double>(1, 0.0));
  ReplayOptions o = as_traced(w);
  o.machine.threads = 4;
  EXPECT_DOUBLE_EQ(replay(w, o).makespan, 20);
}

TEST(FinerCut, RefusesWhatMakesNoSense) {
  const Workload w = row({1, 1}, 1, 1, 1);
  EXPECT_THROW(cut_finer(w, 0, std::vector<double>(2, 0.0)), std::invalid_argument);
  EXPECT_THROW(cut_finer(w, 2, std::vector<double>(1, 0.0)), std::invalid_argument);
}

}  // namespace
}  // namespace moraine::runtime
