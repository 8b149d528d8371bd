// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "runtime/balance/load_model.hpp"

namespace moraine::runtime {
namespace {

double predict(std::string_view name, std::vector<double> loads) { return find_predictor(name).predict(loads); }

TEST(Predictors, ByHand) {
  EXPECT_DOUBLE_EQ(predict("last", {5, 1, 9}), 9);
  EXPECT_DOUBLE_EQ(predict("median", {5, 1, 9}), 5);
  EXPECT_DOUBLE_EQ(predict("median", {5, 1, 9, 6}), 5.5);
  EXPECT_DOUBLE_EQ(predict("trend", {1, 2, 3}), 4);
  EXPECT_DOUBLE_EQ(predict("trend", {0, 1, 1}), 5.0 / 3);  // y = 1/6 + x/2 at x = 3
}

TEST(Predictors, FollowAStraightLine) {
  for (std::size_t count = 2; count <= LoadHistory::kept; ++count) {
    std::vector<double> loads;
    for (std::size_t i = 0; i < count; ++i) loads.push_back(7 + 3.5 * static_cast<double>(i));
    EXPECT_DOUBLE_EQ(predict("trend", loads), 7 + 3.5 * static_cast<double>(count));
  }
}

TEST(Predictors, AgreeOnWhatNeverChanges) {
  for (const PredictorRow& row : predictors()) {
    EXPECT_DOUBLE_EQ(row.predict(std::vector<double>{}), 0) << row.name;
    EXPECT_DOUBLE_EQ(row.predict(std::vector<double>{4}), 4) << row.name;
    EXPECT_DOUBLE_EQ(row.predict(std::vector<double>(5, 0.25)), 0.25) << row.name;
  }
}

TEST(Predictors, NeverForeseeLessThanNothing) { EXPECT_DOUBLE_EQ(predict("trend", {8, 4, 0}), 0); }

TEST(Predictors, MedianForgivesOneSlowEpoch) { EXPECT_DOUBLE_EQ(predict("median", {1, 1, 1, 100, 1}), 1); }

TEST(Predictors, HaveUniqueNamesWithHelp) {
  std::set<std::string_view> names;
  for (const PredictorRow& row : predictors()) {
    EXPECT_TRUE(names.insert(row.name).second);
    EXPECT_FALSE(row.help.empty());
    EXPECT_EQ(find_predictor(row.name).predict, row.predict);
  }
  EXPECT_THROW(find_predictor("oracle"), std::invalid_argument);
}

std::vector<double> loads(const LoadHistory& history) { return {history.loads().begin(), history.loads().end()}; }

TEST(LoadHistory, KeepsTheLastEpochs) {
  LoadHistory history;
  for (int i = 0; i < 8; ++i) history.add(i);
  EXPECT_EQ(loads(history), (std::vector<double>{3, 4, 5, 6, 7}));
}

TEST(LoadHistory, ComesBackAsItWasSaved) {
  for (std::size_t count = 0; count <= 7; ++count) {
    LoadHistory history, other;
    for (std::size_t i = 0; i < count; ++i) history.add(1.0 / static_cast<double>(i + 3));
    other.add(99);
    std::vector<std::byte> bytes(3);  // what came before stays
    history.save(bytes);
    ASSERT_EQ(bytes.size(), 3 + LoadHistory::saved_bytes);
    other.load(std::span(bytes).subspan(3));
    EXPECT_EQ(loads(other), loads(history));
  }
}

TEST(LoadHistory, RefusesDamage) {
  LoadHistory history, kept;
  history.add(1);
  kept.add(2);
  std::vector<std::byte> bytes;
  history.save(bytes);
  EXPECT_THROW(kept.load(std::span(bytes).first(bytes.size() - 1)), std::invalid_argument);
  EXPECT_THROW(kept.load({}), std::invalid_argument);
  std::vector<std::byte> damaged = bytes;
  damaged[7] = std::byte{0xff};
  EXPECT_THROW(kept.load(damaged), std::invalid_argument);
  EXPECT_EQ(loads(kept), std::vector<double>{2});
}

TEST(LoadHistory, RefusesWhatIsNoLoad) {
  LoadHistory history;
  EXPECT_THROW(history.add(-1), std::invalid_argument);
  EXPECT_THROW(history.add(std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW(history.add(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace moraine::runtime
