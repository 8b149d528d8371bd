// SPDX-License-Identifier: Apache-2.0
// Heat in a rod, cut into pieces that only know the runtime's contract, equals the uncut rod bit by bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <tuple>
#include <vector>

#include "runtime/schedule/registry.hpp"
#include "runtime/simulation.hpp"

namespace moraine::runtime {
namespace {

constexpr std::size_t cells = 101;
constexpr std::size_t pieces = 7;
constexpr std::int64_t rounds = 60;

double conducted(double left, double here, double right) { return here + 0.23 * (left - 2 * here + right); }

std::vector<double> first_temperatures() {
  std::vector<double> t(cells);
  for (std::size_t i = 0; i < cells; ++i) t[i] = std::sin(0.37 * static_cast<double>(i * i)) + 1.0 / 3.0;
  return t;
}

/// Insulated at both ends.
std::vector<double> uncut_rod() {
  std::vector<double> t = first_temperatures();
  for (std::int64_t r = 0; r < rounds; ++r) {
    const std::vector<double> before = t;
    for (std::size_t i = 0; i < cells; ++i)
      t[i] = conducted(before[i == 0 ? 0 : i - 1], before[i], before[i + 1 == cells ? i : i + 1]);
  }
  return t;
}

/// Either one stage that receives its own messages of the round before, or one to tell and one to conduct.
enum class Layout { one_stage, two_stages };

class Piece final : public SubModel {
 public:
  Piece(SubModelId id, Layout layout, std::vector<double> t) : id_(id), layout_(layout), t_(std::move(t)) {
    if (id > 0) neighbours_.push_back(id - 1);
    if (id + 1 < pieces) neighbours_.push_back(id + 1);
  }
  std::span<const SubModelId> sources(int stage) const override { return stage == conducting() ? all() : none(); }
  std::span<const SubModelId> targets(int stage) const override { return stage == 0 ? all() : none(); }

  void run(int stage, const Round& round, Port& port) override {
    if (stage == conducting() && !round.opening()) conduct(port);
    if (stage == 0) tell(port);
  }
  double counted_work(int) const override { return static_cast<double>(t_.size()); }
  void save(std::vector<std::byte>& out) const override {
    const auto bytes = std::as_bytes(std::span(t_));
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
  void load(std::span<const std::byte> in) override { std::memcpy(t_.data(), in.data(), in.size()); }
  const std::vector<double>& temperatures() const { return t_; }

 private:
  int conducting() const { return layout_ == Layout::one_stage ? 0 : 1; }
  std::span<const SubModelId> all() const { return neighbours_; }
  static std::span<const SubModelId> none() { return {}; }

  void tell(Port& port) const {
    if (id_ > 0) port.send(id_ - 1, std::as_bytes(std::span(&t_.front(), 1)));
    if (id_ + 1 < pieces) port.send(id_ + 1, std::as_bytes(std::span(&t_.back(), 1)));
  }

  static double told(const Port& port, SubModelId from) {
    double value = 0;
    const auto bytes = port.received(from);
    EXPECT_EQ(bytes.size(), sizeof value);
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }

  void conduct(const Port& port) {
    const double left = id_ > 0 ? told(port, id_ - 1) : t_.front();
    const double right = id_ + 1 < pieces ? told(port, id_ + 1) : t_.back();
    const std::vector<double> before = t_;
    for (std::size_t i = 0; i < t_.size(); ++i)
      t_[i] = conducted(i == 0 ? left : before[i - 1], before[i], i + 1 == t_.size() ? right : before[i + 1]);
  }

  SubModelId id_;
  Layout layout_;
  std::vector<double> t_;
  std::vector<SubModelId> neighbours_;
};

class Rod final : public Model {
 public:
  Rod(Layout layout, std::int64_t epoch) : epoch_(epoch) {
    if (layout == Layout::one_stage) stages_ = {{"conduct", 0}};
    if (layout == Layout::two_stages) stages_ = {{"tell", Stage::none}, {"conduct", 0}};
    const std::vector<double> t = first_temperatures();
    for (std::size_t p = 0; p < pieces; ++p)
      pieces_.push_back(
          std::make_unique<Piece>(static_cast<SubModelId>(p), layout,
                                  std::vector(t.begin() + static_cast<std::ptrdiff_t>(p * cells / pieces),
                                              t.begin() + static_cast<std::ptrdiff_t>((p + 1) * cells / pieces))));
  }
  std::span<const Stage> stages() const override { return stages_; }
  std::size_t size() const override { return pieces_.size(); }
  SubModel& sub_model(SubModelId id) override { return *pieces_[id]; }
  EpochPlan begin_epoch(std::int64_t, std::int64_t at_most) override { return {std::min(epoch_, at_most)}; }

  std::vector<double> temperatures() const {
    std::vector<double> t;
    for (const auto& piece : pieces_) t.insert(t.end(), piece->temperatures().begin(), piece->temperatures().end());
    return t;
  }

 private:
  std::int64_t epoch_;
  std::vector<Stage> stages_;
  std::vector<std::unique_ptr<Piece>> pieces_;
};

std::vector<std::string> scheduler_names() {
  std::vector<std::string> names;
  for (const SchedulerRow& row : schedulers()) names.emplace_back(row.name);
  return names;
}

class Heat : public testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  Options options() const {
    return {.threads = std::get<1>(GetParam()),
            .scheduler = std::get<0>(GetParam()),
            .measured_cost = false,
            .check_messages = true};
  }
  void expect_uncut(Layout layout, std::int64_t epoch) const {
    Rod rod(layout, epoch);
    Simulation(rod, options()).run(0, rounds);
    EXPECT_EQ(rod.temperatures(), uncut_rod()) << "epochs of " << epoch;
  }
};

TEST_P(Heat, OneStageEqualsTheUncutRod) {
  for (const std::int64_t epoch : {1, 7, 60}) expect_uncut(Layout::one_stage, epoch);
}

TEST_P(Heat, TwoStagesEqualTheUncutRod) {
  for (const std::int64_t epoch : {1, 7, 60}) expect_uncut(Layout::two_stages, epoch);
}

TEST_P(Heat, StopsWhereTheCallerWants) {
  Rod rod(Layout::one_stage, 25);
  std::vector<std::int64_t> ends;
  Hooks hooks;
  hooks.until_next_stop = [](std::int64_t next) { return 20 - next % 20; };
  hooks.at_epoch_end = [&](std::int64_t next) { ends.push_back(next); };
  Simulation simulation(rod, options(), hooks);
  simulation.run(0, 50);
  simulation.run(50, rounds - 50);
  EXPECT_EQ(ends, (std::vector<std::int64_t>{20, 40, 50, 60}));
  EXPECT_EQ(rod.temperatures(), uncut_rod());
}

INSTANTIATE_TEST_SUITE_P(Schedulers, Heat,
                         testing::Combine(testing::ValuesIn(scheduler_names()), testing::Values(1, 2, 3, 8)),
                         [](const auto& test) {
                           return std::get<0>(test.param) + "_" + std::to_string(std::get<1>(test.param));
                         });

TEST(HeatPrediction, MeasuredCostChangesNothing) {
  Rod rod(Layout::two_stages, 5);
  Simulation(rod, {.threads = 2, .scheduler = "critical_path", .measured_cost = true, .check_messages = true})
      .run(0, rounds);
  EXPECT_EQ(rod.temperatures(), uncut_rod());
}

}  // namespace
}  // namespace moraine::runtime
