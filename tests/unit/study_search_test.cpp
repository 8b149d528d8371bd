// SPDX-License-Identifier: Apache-2.0
// Grids, fronts and the decisions of the search.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "study/axis.hpp"
#include "study/halving.hpp"
#include "study/log_axis.hpp"
#include "study/pareto.hpp"

namespace moraine::study {
namespace {

using Indices = std::vector<std::size_t>;

TEST(ParetoFront, KeepsWhatNothingBeats) {
  const std::array scores{Score{1, 0.01},   Score{2, 0.02}, Score{2, 0.03},
                          Score{1.5, 0.02}, Score{8, 0.5},  Score{0.5, 0.2}};
  EXPECT_EQ(pareto_front(scores), (Indices{4, 1, 0}));
}

TEST(ParetoFront, OfEqualsTheFirstStays) {
  const std::array scores{Score{1, 0.1}, Score{1, 0.1}, Score{2, 0.1}, Score{2, 0.1}};
  EXPECT_EQ(pareto_front(scores), (Indices{2}));
  EXPECT_TRUE(pareto_front({}).empty());
}

AxisBlock block(const char* engine) {
  return {{"engine", {engine}, "here"}, {"dt", {"1", "2"}, "here"}, {"iterations", {"5"}, "here"}};
}

std::string text_of(const std::vector<Choices>& all) {
  std::string text;
  for (const Choices& choices : all) {
    for (const Choice& c : choices) text += c.name + " " + c.value + " ";
    text += "| ";
  }
  return text;
}

TEST(Grid, IsAllCombinationsOfEveryBlock) {
  const std::array blocks{block("a"), AxisBlock{{"engine", {"b", "c"}, ""}}};
  EXPECT_EQ(text_of(combinations(blocks)),
            "engine a dt 1 iterations 5 | engine a dt 2 iterations 5 | engine b | engine c | ");
}

TEST(Grid, IsNarrowedByEngine) {
  std::vector<AxisBlock> blocks{block("a"), block("b")};
  narrow(blocks, {"engine", {"b", "c"}, ""});
  EXPECT_EQ(text_of(combinations(blocks)), "engine b dt 1 iterations 5 | engine b dt 2 iterations 5 | engine c | ");
}

TEST(Grid, IsNarrowedByOtherAxes) {
  std::vector<AxisBlock> blocks{{{"engine", {"a"}, ""}, {"limit_share", {"1"}, ""}}};
  narrow(blocks, {"substeps", {"3"}, ""});
  narrow(blocks, {"skin", {"0.1", "0.2"}, ""});
  EXPECT_EQ(text_of(combinations(blocks)), "engine a substeps 3 skin 0.1 | engine a substeps 3 skin 0.2 | ");
}

TEST(Grid, BlocksWithoutAnEngineAreForAny) {
  std::vector<AxisBlock> blocks{{{"dt", {"1", "2"}, ""}}};
  narrow(blocks, {"engine", {"a"}, ""});
  EXPECT_EQ(text_of(combinations(blocks)), "dt 1 engine a | dt 2 engine a | ");
}

TEST(Grid, WholeKeysAreShortNames) {
  std::vector<AxisBlock> blocks{{{"run.engine", {"a", "b"}, ""}, {"limit_share", {"1"}, ""}}};
  narrow(blocks, {"engine", {"a"}, ""});
  narrow(blocks, {"time.substeps", {"3"}, ""});
  EXPECT_EQ(text_of(combinations(blocks)), "run.engine a time.substeps 3 | ");
}

TEST(Grid, ShortNamesStandForKeys) {
  EXPECT_EQ(key_of("dt"), "time.dt");
  EXPECT_EQ(key_of("materials.grain.friction"), "materials.grain.friction");
  EXPECT_EQ(flag_of("run.sub_models"), "--sub-models");
  EXPECT_FALSE(flag_of("run.skin"));
}

TEST(Halving, DropsWhatIsSurelyTooBadOrFailed) {
  const std::array candidates{Candidate{3, true, {0.01, 0, 0.02, ""}}, Candidate{1, true, {0.1, 0.09, 0.11, ""}},
                              Candidate{2, true, {0.05, 0.01, 0.09, ""}}, Candidate{0.1, false, {}}};
  EXPECT_EQ(plausible(candidates, 0.02), (Indices{2, 0})) << "cheapest first";
}

TEST(Halving, LooksAtTheCheaperHalf) {
  EXPECT_EQ(half_of(20, 4), 10U);
  EXPECT_EQ(half_of(9, 4), 5U);
  EXPECT_EQ(half_of(5, 4), 4U);
  EXPECT_EQ(half_of(2, 4), 2U);
}

std::array<Comparison, 1> measured(double mean, double deviation, int seeds) {
  return {Comparison{"x", {seeds, mean, deviation}, {10, 1, deviation}, 1}};
}

TEST(Halving, RejectsEarlyButAcceptsOnlyWithEnoughSeeds) {
  EXPECT_EQ(next_step(measured(1.5, 0.001, 2), 0.02, 2, 5, 12).kind, Step::Kind::reject);
  const Step more = next_step(measured(1.001, 0.001, 2), 0.02, 2, 5, 12);
  EXPECT_EQ(more.kind, Step::Kind::more_seeds);
  EXPECT_EQ(more.seeds, 5);
  EXPECT_EQ(next_step(measured(1.001, 0.001, 5), 0.02, 5, 5, 12).kind, Step::Kind::accept);
}

TEST(Halving, AsksForTheSeedsThatDecideOrGivesUp) {
  const Step more = next_step(measured(1.01, 0.012, 5), 0.021, 5, 5, 20);
  EXPECT_EQ(more.kind, Step::Kind::more_seeds);
  EXPECT_GT(more.seeds, 5);
  EXPECT_LE(more.seeds, 20);
  EXPECT_EQ(next_step(measured(1.01, 0.012, 5), 0.021, 5, 5, more.seeds - 1).seeds, more.seeds - 1)
      << "no more than so";
  EXPECT_EQ(next_step(measured(1.01, 0.1, 5), 0.02, 5, 5, 12).kind, Step::Kind::give_up);
  EXPECT_EQ(next_step(measured(1.02, 0.001, 5), 0.02, 5, 5, 12).kind, Step::Kind::give_up) << "on the line";
}

using Kind = Step::Kind;

/// As tune judges: with more seeds of the setting, or of both, until it is decided. `error`: true one, spreads are 1.
Kind judged(std::mt19937& random, double error, double wish, int most) {
  std::normal_distribution<double> spread;
  std::vector<double> measured, reference;
  const auto grow = [&](std::vector<double>& runs, int count, double mean) {
    while (static_cast<int>(runs.size()) < count) runs.push_back(mean + spread(random));
  };
  grow(reference, 3, 0);
  for (int seeds = 2;;) {
    grow(measured, seeds, error);
    const std::array all{Comparison{"x", sample_of(measured), sample_of(reference), 1}};
    const Step step = next_step(all, wish, seeds, 5, most);
    if (step.kind != Kind::more_seeds && step.kind != Kind::more_of_both) return step.kind;
    if (step.kind == Kind::more_of_both) grow(reference, step.seeds, 0);
    seeds = std::max(seeds, step.seeds);
  }
}

/// Looking again and again gives chance more than one chance: 2.5 % of a single look become 2 to 5 %.
TEST(Halving, HardlyEverAcceptsWhatIsTooBad) {
  std::mt19937 random(1);
  constexpr int trials = 4000;
  for (const double wish : {1.0, 2.0, 4.0, 8.0}) {
    int accepted = 0;
    for (int k = 0; k < trials; ++k) accepted += judged(random, wish, wish, 12) == Kind::accept;
    EXPECT_LT(accepted, 0.06 * trials) << wish;
  }
}

TEST(FirstAccepted, StopsThere) {
  const std::array kinds{Kind::reject, Kind::give_up, Kind::accept, Kind::accept};
  const auto verdicts = first_accepted(
      4, [&](std::size_t i) { return kinds[i]; }, [] { return 3; });
  EXPECT_EQ(verdicts, (std::vector<std::optional<Kind>>{Kind::reject, Kind::give_up, Kind::accept, {}}));
}

/// The third candidate makes the reference have more seeds. These decide the second one; the first stays rejected.
TEST(FirstAccepted, MoreEvidenceMayDecideWhatWasUndecided) {
  int seeds = 3;
  std::array<int, 4> judged{};
  const auto judge = [&](std::size_t i) {
    ++judged[i];
    if (i == 2) seeds = 9;
    if (i == 1) return seeds == 9 ? Kind::accept : Kind::give_up;
    return i == 0 ? Kind::reject : Kind::accept;
  };
  const auto verdicts = first_accepted(4, judge, [&] { return seeds; });
  EXPECT_EQ(verdicts, (std::vector<std::optional<Kind>>{Kind::reject, Kind::accept, {}, {}}));
  EXPECT_EQ(judged, (std::array{1, 2, 1, 0}));
}

/// What was accepted by less evidence need not be by more.
TEST(FirstAccepted, MoreEvidenceMayTakeAnAcceptanceBack) {
  int seeds = 3;
  const auto judge = [&](std::size_t i) {
    const int known = std::exchange(seeds, 9);
    return i == 0 && known == 9 ? Kind::reject : Kind::accept;
  };
  const auto verdicts = first_accepted(2, judge, [&] { return seeds; });
  EXPECT_EQ(verdicts, (std::vector<std::optional<Kind>>{Kind::reject, Kind::accept}));
}

TEST(LogAxis, PutsDecadesAtEqualDistances) {
  const LogAxis axis({0.1, 10}, 0, 100);
  EXPECT_NEAR(axis.pixel(1), 50, 1e-9);
  EXPECT_NEAR(axis.pixel(10) - axis.pixel(1), axis.pixel(1) - axis.pixel(0.1), 1e-9);
  EXPECT_EQ(axis.pixel(1e-9), 0);
  EXPECT_TRUE(axis.holds(3));
  EXPECT_FALSE(axis.holds(0.01) || axis.holds(100) || axis.holds(0));
  EXPECT_EQ(axis.pixel(0), 0);
  EXPECT_EQ(axis.ticks(), (std::vector{0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0}));
}

TEST(LogAxis, OfOneValueStillSpansADecade) {
  const LogAxis axis({3}, 0, 100);
  EXPECT_NEAR(axis.pixel(3), 50, 1e-9);
  EXPECT_NEAR(axis.pixel(3 * std::sqrt(10.0)), 100, 1e-6);
}

}  // namespace
}  // namespace moraine::study
