// SPDX-License-Identifier: Apache-2.0
// What seeds allow to say.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "study/error.hpp"
#include "study/report.hpp"
#include "study/statistics.hpp"

namespace moraine::study {
namespace {

TEST(Statistics, SampleOfKnownNumbers) {
  const std::array values{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
  const Sample s = sample_of(values);
  EXPECT_EQ(s.count, 8);
  EXPECT_DOUBLE_EQ(s.mean, 5);
  EXPECT_NEAR(s.deviation, std::sqrt(32.0 / 7), 1e-12);
  EXPECT_EQ(sample_of(std::span(values).first(1)).deviation, 0);
}

TEST(Statistics, StudentAsInTables) {
  EXPECT_DOUBLE_EQ(student_t(1), 12.706);
  EXPECT_DOUBLE_EQ(student_t(4.9), 2.776) << "fewer degrees, to be safe";
  EXPECT_NEAR(student_t(40), 2.021, 5e-4);
  EXPECT_NEAR(student_t(120), 1.980, 5e-4);
  EXPECT_NEAR(student_t(1e9), 1.95996, 1e-5);
  EXPECT_TRUE(std::isinf(student_t(0.5)));
}

TEST(Statistics, WelchOfKnownSamples) {
  const Difference d = difference({4, 10, 2}, {9, 8, 3});  // both means to 1; 4 / (1/3 + 1/8) = 8.7 degrees
  EXPECT_DOUBLE_EQ(d.value, 2);
  EXPECT_NEAR(d.uncertainty, 2.306 * std::sqrt(2.0), 1e-9);
}

TEST(Statistics, AgainstAnExactValueOnlyOneMeanIsUncertain) {
  EXPECT_NEAR(difference({4, 10, 2}, exactly(10)).uncertainty, 3.182, 1e-9);
}

TEST(Statistics, OneRunBorrowsTheOthersSpread) {
  EXPECT_NEAR(difference({1, 10, 0}, {3, 8, 1}).uncertainty, 4.303 * std::sqrt(1 + 1.0 / 3), 1e-9);
  EXPECT_TRUE(std::isinf(difference({1, 10, 0}, exactly(8)).uncertainty)) << "nothing is known";
  EXPECT_TRUE(std::isinf(difference({1, 10, 0}, {1, 8, 0}).uncertainty));
}

/// The interval is to hold the true difference in 95 of 100 cases.
TEST(Statistics, IntervalsHoldWhatTheyPromise) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> a(1, 0.5), b(0, 2);
  int held = 0;
  constexpr int trials = 4000;
  for (int i = 0; i < trials; ++i) {
    std::array<double, 5> x{};
    std::array<double, 3> y{};
    for (double& v : x) v = a(random);
    for (double& v : y) v = b(random);
    const Difference d = difference(sample_of(x), sample_of(y));
    held += std::abs(d.value - 1) <= d.uncertainty;
  }
  EXPECT_GT(held, 0.94 * trials);
  EXPECT_LT(held, 0.985 * trials) << "wider than need be";
}

TEST(Statistics, RunsNeededMakeTheMargin) {
  const Sample a{3, 0, 1}, b{3, 0, 1};
  const auto both = runs_needed(a, b, 0.5, true);
  ASSERT_TRUE(both);
  EXPECT_LE(difference({*both, 0, 1}, {*both, 0, 1}).uncertainty, 0.5);
  EXPECT_GT(difference({*both - 2, 0, 1}, {*both - 2, 0, 1}).uncertainty, 0.5);
  EXPECT_FALSE(runs_needed(a, b, 0.5, false)) << "the reference alone is off by more";
  EXPECT_FALSE(runs_needed(a, b, 0, true));
}

TEST(Statistics, LoneRunsBorrowTheOthersSpread) {
  const Sample lone{1, 0, 0}, many{5, 0, 1};
  EXPECT_EQ(runs_needed(lone, many, 0.7, true), runs_needed(many, many, 0.7, true));
  EXPECT_EQ(runs_needed(many, lone, 0.7, true), runs_needed(many, many, 0.7, true));
  EXPECT_FALSE(runs_needed(lone, exactly(0), 0.7, false)) << "nothing is known of its spread";
  EXPECT_FALSE(runs_needed(lone, lone, 0.7, true));
}

Comparison compared(const char* name, double mean, double scale = 1) {
  return {name, {5, mean, 0.01}, {5, 1, 0.01}, scale};
}

TEST(ErrorOfASetting, IsThatOfItsWorstObservable) {
  const std::array all{compared("a", 1.05), compared("b", 0.8, 10), compared("c", 0.9)};
  const Error e = error_of(all);
  EXPECT_EQ(e.worst, "c");
  EXPECT_NEAR(e.value, 0.1, 1e-12);
  EXPECT_LT(e.low, e.value);
  EXPECT_NEAR(e.high - e.value, e.value - e.low, 1e-12);
}

TEST(ErrorOfASetting, IsNotRelativeToZero) {
  const std::array far{Comparison{"x", {5, 1001, 0.01}, {5, 1000, 0.01}, 2}};
  EXPECT_NEAR(error_of(far).value, 0.5, 1e-12);
}

TEST(ErrorOfASetting, IsJudgedByItsInterval) {
  EXPECT_EQ(judge({0.01, 0.005, 0.015, "x"}, 0.02), Verdict::below);
  EXPECT_EQ(judge({0.03, 0.025, 0.035, "x"}, 0.02), Verdict::above);
  EXPECT_EQ(judge({0.01, 0, 0.021, "x"}, 0.02), Verdict::undecided);
  EXPECT_EQ(judge({0, 0, 0.021, "x"}, 0.02), Verdict::undecided) << "no claim below the noise";
}

TEST(ErrorOfASetting, SaysHowManySeedsWouldDecide) {
  const std::array all{Comparison{"x", {3, 1.01, 0.02}, {3, 1, 0.02}, 1}};
  ASSERT_EQ(judge(error_of(all), 0.02), Verdict::undecided);
  const SeedsNeeded needed = seeds_to_decide(all, 0.02);
  ASSERT_TRUE(needed.of_both);
  std::array more = all;
  more[0].measured.count = more[0].reference.count = *needed.of_both;
  EXPECT_EQ(judge(error_of(more), 0.02), Verdict::below);
  EXPECT_GT(*needed.of_both, 20);
}

TEST(ErrorOfASetting, NamesSeedsOfTheReferenceIfThatAreFewer) {
  EXPECT_EQ(seeds_text({2864, 70}), "about 2864 seeds of it or 70 seeds of it and of the reference would decide");
  EXPECT_EQ(seeds_text({12, 12}), "about 12 seeds of it would decide");
  EXPECT_EQ(seeds_text({std::nullopt, 30}), "about 30 seeds of it and of the reference would decide");
  EXPECT_EQ(seeds_text({}), "no number of seeds is known that would decide");
}

}  // namespace
}  // namespace moraine::study
