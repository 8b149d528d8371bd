// SPDX-License-Identifier: Apache-2.0
// The parts of the coupling one by one: messages, neighbours, the cell grid.
#include <gtest/gtest.h>

#include <algorithm>

#include "ghosting/coupling.hpp"
#include "ghosting/messages.hpp"
#include "ghosting/neighbours.hpp"
#include "physics/cell_grid.hpp"
#include "physics/errors.hpp"
#include "tests/support/dice.hpp"

namespace moraine {
namespace {

using test::Dice;

TEST(CouplingTable, ListsItselfIfAskedForAnother) {
  try {
    find_coupling("glue", find_engine("bullet"));
    FAIL();
  } catch (const InputError& e) {
    for (const CouplingRow& row : couplings()) {
      EXPECT_NE(std::string(e.what()).find(row.name), std::string::npos) << row.name;
      EXPECT_NE(row.make(), nullptr);
    }
  }
}

TEST(Rotation, IsTheWayBetweenTwoOrientations) {
  Dice dice(4);
  for (int k = 0; k < 100; ++k) {
    const Quat from = dice.turn(), to = dice.turn();
    const Vec3 r = rotation_between(from, to);
    EXPECT_LE(r.norm(), 3.1415927);
    EXPECT_LT(rotated(from, r).angularDistance(to), 1e-7);
  }
  EXPECT_EQ(rotation_between(Quat::Identity(), Quat::Identity()), Vec3::Zero());
  EXPECT_EQ(rotated(Quat::Identity(), Vec3::Zero()).coeffs(), Quat::Identity().coeffs());
}

StepMessage step_message() {
  Dice dice(7);
  StepMessage m;
  m.results = {{3, 0, dice.motion()}, {9, 0, dice.motion()}};
  m.border = {{dice.vec(4), dice.vec(1), 0.5}, {dice.vec(4), dice.vec(1), 0.25}, {dice.vec(4), dice.vec(1), 1e-9}};
  m.broken_bonds = {1, 5, 4'000'000'000U};
  return m;
}

BoundMessage bound_message() {
  Dice dice(8);
  BoundMessage m;
  m.bounds = {Vec3(-1, -2, -3), Vec3(4, 5, 6)};
  m.max_speed = 12.5;
  m.ghosts = {{2, true, 0.25, {{dice.vec(9), dice.turn()}, {dice.vec(1), dice.vec(1)}}}};
  m.broken_bonds = {0, 7};
  return m;
}

TEST(Messages, OfAStepComeBackAsTheyWere) {
  const StepMessage m = step_message();
  std::vector<std::byte> bytes(5);  // what was there before does not matter
  m.write(bytes);
  StepMessage back;
  back.results.resize(7);
  back.read(bytes);
  ASSERT_EQ(back.results.size(), 2U);
  EXPECT_EQ(back.results[1].element, 9U);
  EXPECT_EQ(back.results[1].motion.displacement, m.results[1].motion.displacement);
  EXPECT_EQ(back.results[1].motion.rotation, m.results[1].motion.rotation);
  EXPECT_EQ(back.results[1].motion.twist.linear, m.results[1].motion.twist.linear);
  EXPECT_EQ(back.results[1].motion.twist.angular, m.results[1].motion.twist.angular);
  ASSERT_EQ(back.border.size(), 3U);
  EXPECT_EQ(back.border[2].position, m.border[2].position);
  EXPECT_EQ(back.border[2].velocity, m.border[2].velocity);
  EXPECT_EQ(back.border[2].radius, 1e-9);
  EXPECT_EQ(back.broken_bonds, m.broken_bonds);
}

TEST(Messages, OfBoundsComeBackAsTheyWere) {
  const BoundMessage m = bound_message();
  std::vector<std::byte> bytes;
  m.write(bytes);
  BoundMessage back;
  back.read(bytes);
  EXPECT_EQ(back.bounds.min, m.bounds.min);
  EXPECT_EQ(back.bounds.max, m.bounds.max);
  EXPECT_EQ(back.max_speed, 12.5);
  ASSERT_EQ(back.ghosts.size(), 1U);
  EXPECT_EQ(back.ghosts[0].element, 2U);
  EXPECT_EQ(back.ghosts[0].share, 0.25);
  EXPECT_TRUE(back.ghosts[0].carries);
  EXPECT_EQ(back.ghosts[0].start.pose.position, m.ghosts[0].start.pose.position);
  EXPECT_EQ(back.ghosts[0].start.pose.orientation.coeffs(), m.ghosts[0].start.pose.orientation.coeffs());
  EXPECT_EQ(back.ghosts[0].start.twist.angular, m.ghosts[0].start.twist.angular);
  EXPECT_EQ(back.broken_bonds, m.broken_bonds);
}

TEST(Messages, BoundsOfNothingComeBackEmpty) {
  std::vector<std::byte> bytes;
  BoundMessage{}.write(bytes);
  BoundMessage back = bound_message();
  back.read(bytes);
  EXPECT_TRUE(back.bounds.empty());
  EXPECT_TRUE(back.ghosts.empty());
  EXPECT_TRUE(back.broken_bonds.empty());
}

template <class Message>
void expect_refused_when_cut(const Message& message) {
  std::vector<std::byte> bytes;
  message.write(bytes);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    Message back;
    EXPECT_THROW(back.read(std::span(bytes).first(length)), IoError) << length << " of " << bytes.size();
  }
  std::fill(bytes.begin(), bytes.end(), std::byte{0xff});  // absurd counts
  Message back;
  EXPECT_THROW(back.read(bytes), IoError);
}

TEST(Messages, CutShortAreRefused) {
  expect_refused_when_cut(step_message());
  expect_refused_when_cut(bound_message());
}

/// Gap between two boxes [m].
double gap(const Bounds& a, const Bounds& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(Vec3::Zero()).norm();
}

TEST(Neighbours, AreAllThatCanMeetAndRoundsHold) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Dice dice(seed);
    std::vector<Reach> reaches;
    double speed = 0;
    const int n = static_cast<int>(dice.in(0, 12));
    for (int k = 0; k < n; ++k) {
      Reach r;
      r.max_speed = dice.in(0, 4);
      speed = std::max(speed, r.max_speed);
      const Vec3 at = dice.vec(15);
      if (k % 5 != 4) r.bounds = {at, at + Vec3(dice.in(0, 5), dice.in(0, 5), dice.in(0, 5))};
      reaches.push_back(r);
    }
    const double g = seed % 2 ? 9.81 : 0, h = 1.0 / 240;
    const auto at_most = static_cast<std::int64_t>(dice.in(1, 200));
    const Neighbourhood near = find_neighbours(reaches, 0, 1, g, h, at_most);
    EXPECT_GE(near.rounds, 1);
    EXPECT_LE(near.rounds, at_most);
    EXPECT_TRUE(std::is_sorted(near.pairs.begin(), near.pairs.end()));
    const double t = static_cast<double>(near.rounds) * h;
    const double reach = 2 * (speed * t + g * t * t / 2);  // both may come towards each other
    for (SubModelId a = 0; a < reaches.size(); ++a)
      for (SubModelId b = a + 1; b < reaches.size(); ++b) {
        if (reaches[a].bounds.empty() || reaches[b].bounds.empty()) continue;
        const bool listed = std::binary_search(near.pairs.begin(), near.pairs.end(), std::pair(a, b));
        EXPECT_TRUE(listed || gap(reaches[a].bounds, reaches[b].bounds) > reach) << a << " " << b;
      }
    for (const auto& [a, b] : near.pairs) EXPECT_LT(a, b);
  }
}

TEST(Neighbours, EmptySubModelsHaveNone) {
  std::vector<Reach> reaches(3);
  reaches[0].bounds = reaches[2].bounds = {Vec3(0, 0, 0), Vec3(1, 1, 1)};
  const Neighbourhood near = find_neighbours(reaches, 0, 1, 9.81, 0.01, 50);
  EXPECT_EQ(near.pairs, (std::vector<std::pair<SubModelId, SubModelId>>{{0, 2}}));
}

TEST(Neighbours, RoundsShrinkWithSpeedAndWithTheRoundsLeft) {
  const auto rounds = [](double speed, std::int64_t at_most) {
    return find_neighbours(std::vector<Reach>{{{Vec3::Zero(), Vec3::Ones()}, speed}}, 0, 1, 9.81, 1.0 / 240, at_most)
        .rounds;
  };
  EXPECT_EQ(rounds(0, 1), 1);
  EXPECT_EQ(rounds(100, 3), 3);
  EXPECT_GE(rounds(0, 1000), rounds(5, 1000));
  EXPECT_GE(rounds(5, 1000), rounds(50, 1000));
  EXPECT_GE(rounds(1e6, 1000), 1);
}

TEST(CellGrid, FindsWhatBruteForceFinds) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Dice dice(seed);
    std::vector<std::array<double, 3>> points;
    const int n = static_cast<int>(dice.in(0, 400));
    const double reach = dice.in(0.1, 20);
    for (int k = 0; k < n; ++k) points.push_back({dice.in(0, reach), dice.in(-5, 5), dice.in(0, seed % 3 ? 1 : 0)});
    const double cell = dice.in(0.05, 3);
    CellGrid<double> grid;
    grid.build(points, cell);
    for (int k = 0; k < 50; ++k) {
      const std::array<double, 3> at{dice.in(-1, reach + 1), dice.in(-6, 6), dice.in(-1, 2)};
      std::vector<std::uint32_t> found;
      grid.around(at, [&](std::uint32_t i) { found.push_back(i); });
      std::sort(found.begin(), found.end());
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "visited twice";
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        double d2 = 0;
        for (int a = 0; a < 3; ++a) d2 += (points[i][a] - at[a]) * (points[i][a] - at[a]);
        EXPECT_TRUE(d2 >= cell * cell || std::binary_search(found.begin(), found.end(), i));
      }
    }
  }
}

TEST(CellGrid, HoldsPointsFarApartWithoutCellsForAllBetween) {
  const std::vector<std::array<double, 3>> points{{0, 0, 0}, {1e9, 1e9, 1e9}, {0.5, 0, 0}};
  CellGrid<double> grid;
  grid.build(points, 1.0);
  std::vector<std::uint32_t> found;
  grid.around({0, 0, 0}, [&](std::uint32_t i) { found.push_back(i); });
  EXPECT_TRUE(std::count(found.begin(), found.end(), 0U) == 1 && std::count(found.begin(), found.end(), 2U) == 1);
}

}  // namespace
}  // namespace moraine
