// SPDX-License-Identifier: Apache-2.0
// The parts of the coupling one by one: consensus, messages, neighbours, the cell grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "ghosting/coupling.hpp"
#include "ghosting/messages.hpp"
#include "ghosting/neighbours.hpp"
#include "physics/cell_grid.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 vec(double reach) { return {in(-reach, reach), in(-reach, reach), in(-reach, reach)}; }
  Quat turn() { return Quat(in(-1, 1), in(-1, 1), in(-1, 1), in(-1, 1)).normalized(); }
  CopyMotion motion() { return {vec(0.1), vec(0.1), {vec(3), vec(3)}}; }

 private:
  std::mt19937 random_;
};

std::vector<SubModelId> pick(Dice& dice, SubModelId owner) {
  std::set<SubModelId> worlds{owner};
  const int ghosts = static_cast<int>(dice.in(0, 5));
  for (int k = 0; k < ghosts; ++k) worlds.insert(static_cast<SubModelId>(dice.in(0, 9)));
  return {worlds.begin(), worlds.end()};
}

Twist carried(const SharedElement& shared) {
  Twist sum;
  for (const Copy& c : shared.copies) {
    sum.linear += c.offset.linear;
    sum.angular += c.offset.angular;
  }
  return sum;
}

TEST(Consensus, HostsOnOneSideOfACut) {
  const auto c = make_consensus();
  for (SubModelId a = 0; a < 5; ++a)
    for (SubModelId b = 0; b < 5; ++b) EXPECT_TRUE(a == b || c->hosts(a, b) != c->hosts(b, a)) << a << " " << b;
}

TEST(Consensus, CopiesShareTheMass) {
  for (const std::size_t copies : {1U, 2U, 3U, 8U})
    EXPECT_NEAR(make_consensus()->mass_share(copies) * static_cast<double>(copies), 1, 1e-15);
}

TEST(Consensus, MeanHasTheMomentumOfTheCopies) {
  Dice dice(1);
  const auto consensus = make_consensus();
  SharedElement shared;
  shared.start.pose.position = Vec3(5, 6, 7);
  shared.copies = {Copy::in(0), Copy::in(2), Copy::in(3)};
  const std::vector<CopyMotion> motions{dice.motion(), dice.motion(), dice.motion()};
  const double disagreement = consensus->combine(shared, motions, {2, Vec3::Zero(), 0.85});
  const double share = consensus->mass_share(3);
  Vec3 p = Vec3::Zero(), l = Vec3::Zero(), x = Vec3::Zero();
  for (const CopyMotion& m : motions) {
    p += share * m.twist.linear;
    l += share * m.twist.angular;
    x += share * m.displacement;
  }
  EXPECT_LT((shared.state.twist.linear - p).norm(), 1e-14);
  EXPECT_LT((shared.state.twist.angular - l).norm(), 1e-14);
  EXPECT_LT((shared.state.pose.position - Vec3(5, 6, 7) - x).norm(), 1e-14);
  EXPECT_NEAR(shared.state.pose.orientation.norm(), 1, 1e-15);
  EXPECT_GT(disagreement, 0);
}

TEST(Consensus, CopiesThatAgreeCarryNothing) {
  Dice dice(2);
  SharedElement shared;
  shared.copies = {Copy::in(0), Copy::in(1)};
  const CopyMotion motion = dice.motion();
  const std::vector<CopyMotion> motions{motion, motion};
  EXPECT_EQ(make_consensus()->combine(shared, motions, {}), 0);
  EXPECT_LT(shared.copies[0].offset.linear.norm() + shared.copies[1].offset.angular.norm(), 1e-14);
  EXPECT_LT((shared.state.pose.orientation.coeffs() - rotated(Quat::Identity(), motion.rotation).coeffs()).norm(),
            1e-15);
}

/// At rest on one copy of two: the other must come to carry half the weight of the element.
TEST(Consensus, LoadThatOneCopyCarriesIsPassedOn) {
  const auto consensus = make_consensus();
  const Vec3 gravity_step(0, 0, -0.1);
  SharedElement shared;
  shared.copies = {Copy::in(0), Copy::in(1)};
  for (int k = 0; k < 200; ++k) {
    CopyMotion held, falls;  // copy 0 stands on something, copy 1 feels gravity and what it carries only
    falls.twist.linear = shared.state.twist.linear + shared.copies[1].offset.linear + gravity_step;
    consensus->combine(shared, std::vector<CopyMotion>{held, falls}, {0, gravity_step, 1.0});
  }
  EXPECT_NEAR(shared.copies[1].offset.linear.z(), 0.1, 1e-12);
  EXPECT_NEAR(shared.copies[0].offset.linear.z(), -0.1, 1e-12);
  EXPECT_NEAR(shared.state.twist.linear.z(), 0, 1e-12);
}

TEST(Consensus, OffsetsSumToNothingWhateverCopiesComeAndGo) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Dice dice(seed);
    const auto consensus = make_consensus();
    const auto owner = static_cast<SubModelId>(dice.in(0, 9));
    SharedElement shared;
    shared.copies = {Copy::in(owner)};
    for (int k = 0; k < 40; ++k) {
      const std::vector<SubModelId> worlds = pick(dice, owner);
      consensus->change_copies(shared, worlds, owner);
      ASSERT_EQ(shared.copies.size(), worlds.size());
      for (std::size_t c = 0; c < worlds.size(); ++c) ASSERT_EQ(shared.copies[c].world, worlds[c]);
      std::vector<CopyMotion> motions;
      for (std::size_t c = 0; c < worlds.size(); ++c) motions.push_back(dice.motion());
      consensus->combine(shared, motions, {owner, Vec3::Zero(), 0.85});
      ASSERT_LT(carried(shared).linear.norm() + carried(shared).angular.norm(), 1e-12);
    }
    consensus->change_copies(shared, std::vector<SubModelId>{owner}, owner);
    EXPECT_LT(carried(shared).linear.norm() + carried(shared).angular.norm(), 1e-12) << "alone, it carries nothing";
  }
}

TEST(Consensus, NewCopiesStartWithNothingAndOldOnesKeepTheirLoad) {
  SharedElement shared;
  shared.copies = {{1, {Vec3(1, 0, 0), Vec3(0, 2, 0)}, {}}, {4, {Vec3(-1, 0, 0), Vec3(0, -2, 0)}, {}}};
  const auto consensus = make_consensus();
  consensus->change_copies(shared, std::vector<SubModelId>{1, 2, 4}, 1);
  EXPECT_EQ(shared.copies[1].offset.linear, Vec3::Zero());
  const double before = consensus->mass_share(2), after = consensus->mass_share(3);
  EXPECT_NEAR(after * shared.copies[2].offset.linear.x(), before * -1, 1e-15);
  EXPECT_NEAR(after * shared.copies[0].offset.angular.y(), before * 2, 1e-15);
}

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
  m.border = {{dice.vec(4), 0.5}, {dice.vec(4), 0.25}, {dice.vec(4), 1e-9}};
  m.broken_bonds = {1, 5, 4'000'000'000U};
  return m;
}

BoundMessage bound_message() {
  Dice dice(8);
  BoundMessage m;
  m.bounds = {Vec3(-1, -2, -3), Vec3(4, 5, 6)};
  m.max_speed = 12.5;
  m.ghosts = {{2, 3, {{dice.vec(9), dice.turn()}, {dice.vec(1), dice.vec(1)}}}};
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
  EXPECT_EQ(back.ghosts[0].copies, 3U);
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
    const Neighbourhood near = find_neighbours(reaches, 1, g, h, at_most);
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
  const Neighbourhood near = find_neighbours(reaches, 1, 9.81, 0.01, 50);
  EXPECT_EQ(near.pairs, (std::vector<std::pair<SubModelId, SubModelId>>{{0, 2}}));
}

TEST(Neighbours, RoundsShrinkWithSpeedAndWithTheRoundsLeft) {
  const auto rounds = [](double speed, std::int64_t at_most) {
    return find_neighbours(std::vector<Reach>{{{Vec3::Zero(), Vec3::Ones()}, speed}}, 1, 9.81, 1.0 / 240, at_most)
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
