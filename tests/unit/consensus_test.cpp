// SPDX-License-Identifier: Apache-2.0
// Consensus: who has the mass, the mean, and what copies carry.
#include <gtest/gtest.h>

#include <set>

#include "ghosting/coupling.hpp"
#include "tests/support/dice.hpp"

namespace moraine {
namespace {

using test::Dice;

std::vector<SubModelId> pick(Dice& dice, SubModelId owner) {
  std::set<SubModelId> worlds{owner};
  const int ghosts = static_cast<int>(dice.in(0, 5));
  for (int k = 0; k < ghosts; ++k) worlds.insert(static_cast<SubModelId>(dice.in(0, 9)));
  return {worlds.begin(), worlds.end()};
}

Twist carried(const SharedElement& shared) {
  Twist sum;
  for (const Copy& c : shared.copies) sum += c.share * c.offset;
  return sum;
}

/// Copies in these worlds, the first the real one. All meet something.
SharedElement in_worlds(const std::vector<SubModelId>& worlds) {
  SharedElement shared;
  for (const SubModelId w : worlds) {
    shared.copies.push_back(Copy::in(w));
    shared.copies.back().meets = true;
    shared.copies.back().unpushed = 0;
  }
  make_consensus()->share_out(shared, worlds.front());
  return shared;
}

TEST(Consensus, HostsOnOneSideOfACut) {
  const auto c = make_consensus();
  for (SubModelId a = 0; a < 5; ++a)
    for (SubModelId b = 0; b < 5; ++b) EXPECT_TRUE(a == b || c->hosts(a, b) != c->hosts(b, a)) << a << " " << b;
}

TEST(Consensus, CopiesThatMeetSomethingShareTheMass) {
  SharedElement shared = in_worlds({1, 2, 3});
  for (const Copy& c : shared.copies) {
    EXPECT_NEAR(c.share, 1.0 / 3, 1e-15);
    EXPECT_TRUE(c.carries);
  }
  shared.copies[0].meets = false;
  shared.copies[0].unpushed = Copy::never;
  make_consensus()->share_out(shared, 1);
  EXPECT_NEAR(shared.copies[0].share, 0.001, 1e-15);
  EXPECT_NEAR(shared.copies[1].share, 0.4995, 1e-15);
  EXPECT_FALSE(shared.copies[0].carries);
}

TEST(Consensus, TheRealCopyHasTheMassIfNoneMeetsAnything) {
  SharedElement shared;
  shared.copies = {Copy::in(4), Copy::in(7)};
  make_consensus()->share_out(shared, 7);
  EXPECT_NEAR(shared.copies[0].share, 0.001, 1e-15);
  EXPECT_NEAR(shared.copies[1].share, 0.999, 1e-15);
}

TEST(Consensus, ACopyThatWasPushedKeepsItsShareForAWhile) {
  const auto consensus = make_consensus();
  SharedElement shared = in_worlds({0, 1});
  shared.copies[1].meets = false;
  int substeps = 0;
  for (; shared.copies[1].share > 0.1; ++substeps) {
    ASSERT_LT(substeps, 100);
    const CopyMotion still;
    CopyMotion pushed;
    pushed.twist.linear = Vec3(0.1, 0, 0) + shared.state.twist.linear + shared.copies[0].offset.linear;
    shared.copies[1].offset = {};
    CopyMotion alone;
    alone.twist = shared.state.twist;
    consensus->combine(shared, std::vector<CopyMotion>{pushed, alone}, {0, Vec3::Zero(), 0.85});
    consensus->share_out(shared, 0);
  }
  EXPECT_GE(substeps, 2);
  EXPECT_LT(substeps, 10);
}

TEST(Consensus, MeanHasTheMomentumOfTheCopies) {
  Dice dice(1);
  const auto consensus = make_consensus();
  SharedElement shared = in_worlds({2, 0, 3});
  shared.copies[1].meets = false;
  shared.copies[1].unpushed = Copy::never;
  consensus->share_out(shared, 2);
  shared.start.pose.position = Vec3(5, 6, 7);
  const std::vector<CopyMotion> motions{dice.motion(), dice.motion(), dice.motion()};
  Vec3 p = Vec3::Zero(), l = Vec3::Zero(), x = Vec3::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    const double share = shared.copies[c].share;
    p += share * motions[c].twist.linear;
    l += share * motions[c].twist.angular;
    x += share * motions[c].displacement;
  }
  const double disagreement = consensus->combine(shared, motions, {2, Vec3::Zero(), 0.85});
  EXPECT_LT((shared.state.twist.linear - p).norm(), 1e-14);
  EXPECT_LT((shared.state.twist.angular - l).norm(), 1e-14);
  EXPECT_LT((shared.state.pose.position - Vec3(5, 6, 7) - x).norm(), 1e-14);
  EXPECT_NEAR(shared.state.pose.orientation.norm(), 1, 1e-15);
  EXPECT_GT(disagreement, 0);
}

TEST(Consensus, CopiesThatAgreeCarryNothing) {
  Dice dice(2);
  SharedElement shared = in_worlds({0, 1});
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
  SharedElement shared = in_worlds({0, 1});
  for (int k = 0; k < 200; ++k) {
    CopyMotion held, falls;  // copy 0 stands on something, copy 1 feels gravity and what it carries only
    falls.twist.linear = shared.state.twist.linear + shared.copies[1].offset.linear + gravity_step;
    consensus->combine(shared, std::vector<CopyMotion>{held, falls}, {0, gravity_step, 1.0});
  }
  EXPECT_NEAR(shared.copies[1].offset.linear.z(), 0.1, 1e-12);
  EXPECT_NEAR(shared.copies[0].offset.linear.z(), -0.1, 1e-12);
  EXPECT_NEAR(shared.state.twist.linear.z(), 0, 1e-12);
}

TEST(Consensus, WhatCopiesCarrySumsToNothingWhateverTheyMeetAndHoweverTheyComeAndGo) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Dice dice(seed);
    const auto consensus = make_consensus();
    const auto owner = static_cast<SubModelId>(dice.in(0, 9));
    SharedElement shared;
    shared.copies = {Copy::in(owner)};
    for (int k = 0; k < 60; ++k) {
      const std::vector<SubModelId> worlds = pick(dice, owner);
      consensus->change_copies(shared, worlds, owner);
      ASSERT_EQ(shared.copies.size(), worlds.size());
      double shares = 0;
      for (std::size_t c = 0; c < worlds.size(); ++c) {
        ASSERT_EQ(shared.copies[c].world, worlds[c]);
        shared.copies[c].meets = dice.in(0, 1) < 0.5;
      }
      consensus->share_out(shared, owner);
      for (const Copy& c : shared.copies) shares += c.share;
      ASSERT_NEAR(shares, 1, 1e-14);
      std::vector<CopyMotion> motions;
      for (const Copy& c : shared.copies) {
        CopyMotion unpushed;
        unpushed.twist = shared.state.twist + c.offset;
        motions.push_back(dice.in(0, 1) < 0.2 ? dice.motion() : unpushed);
      }
      consensus->combine(shared, motions, {owner, Vec3::Zero(), 0.85});
      ASSERT_LT(carried(shared).linear.norm() + carried(shared).angular.norm(), 1e-12);
    }
    consensus->change_copies(shared, std::vector<SubModelId>{owner}, owner);
    EXPECT_LT(carried(shared).linear.norm() + carried(shared).angular.norm(), 1e-12) << "alone, it carries nothing";
  }
}

TEST(Consensus, NewCopiesStartWithNothingAndOldOnesKeepTheirLoad) {
  SharedElement shared = in_worlds({1, 4});
  shared.copies[0].offset = {Vec3(1, 0, 0), Vec3(0, 2, 0)};
  shared.copies[1].offset = {Vec3(-1, 0, 0), Vec3(0, -2, 0)};
  const auto consensus = make_consensus();
  consensus->change_copies(shared, std::vector<SubModelId>{1, 2, 4}, 1);
  shared.copies[1].meets = true;
  consensus->share_out(shared, 1);
  EXPECT_EQ(shared.copies[1].offset.linear, Vec3::Zero());
  EXPECT_NEAR(shared.copies[2].share * shared.copies[2].offset.linear.x(), -0.5, 1e-15);
  EXPECT_NEAR(shared.copies[0].share * shared.copies[0].offset.angular.y(), 1, 1e-15);
}

TEST(Consensus, ACopyThatMeetsNothingHandsOnWhatItCarries) {
  SharedElement shared = in_worlds({1, 4, 5});
  const double loads[] = {3, -1, -2};
  for (std::size_t c = 0; c < 3; ++c) shared.copies[c].offset.linear = Vec3(loads[c], 0, 0);
  shared.copies[2].meets = false;
  shared.copies[2].unpushed = Copy::never;
  make_consensus()->share_out(shared, 1);
  EXPECT_EQ(shared.copies[2].offset.linear.x(), 0);
  EXPECT_NEAR(shared.copies[0].share * shared.copies[0].offset.linear.x(), (3 - 1) / 3.0, 1e-15);
  EXPECT_NEAR(shared.copies[1].share * shared.copies[1].offset.linear.x(), (-1 - 1) / 3.0, 1e-15);
}

}  // namespace
}  // namespace moraine
