// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/packing.hpp"

#include <gtest/gtest.h>

#include "physics/scene/random.hpp"

namespace moraine {
namespace {

int contacts_of(const std::vector<Vec3>& points, std::size_t i, double diameter) {
  int contacts = 0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (j == i) continue;
    const double distance = (points[i] - points[j]).norm();
    EXPECT_GE(distance, diameter * (1 - 1e-12));
    if (distance < diameter * (1 + 1e-9)) ++contacts;
  }
  return contacts;
}

TEST(Packing, HcpSpheresInsideHaveTwelveNeighbours) {
  const auto points = pack_lattice({Lattice::Kind::hcp, 0.5, 1}, {5, 5, 5}, Vec3(1, 2, 3));
  ASSERT_EQ(points.size(), 125u);
  EXPECT_EQ(contacts_of(points, 62, 0.5), 12);
}

TEST(Packing, CubicSpheresInsideHaveSixNeighbours) {
  const auto points = pack_lattice({Lattice::Kind::cubic, 2, 1}, {3, 3, 3}, Vec3::Zero());
  ASSERT_EQ(points.size(), 27u);
  EXPECT_EQ(contacts_of(points, 13, 2), 6);
}

TEST(Packing, LatticeStaysInsideItsBoxAndFillsIt) {
  const Bounds box{{-1, -2, -3}, {7, 6, 5}};
  for (const auto kind : {Lattice::Kind::hcp, Lattice::Kind::cubic}) {
    const auto points = pack_lattice({kind, 0.8, 1}, box);
    for (const Vec3& p : points) {
      EXPECT_TRUE((p.array() >= box.min.array() + 0.4 - 1e-6).all());
      EXPECT_TRUE((p.array() <= box.max.array() - 0.4 + 1e-6).all());
    }
    const double filled = static_cast<double>(points.size()) * 0.5236 * 0.512 / 512;
    EXPECT_GT(filled, kind == Lattice::Kind::hcp ? 0.6 : 0.5);
  }
}

TEST(Packing, CountTakesTheLowest) {
  const Bounds box{{0, 0, 0}, {4, 4, 4}};
  const auto all = pack_lattice({}, box);
  const auto some = pack_lattice({}, box, 10);
  ASSERT_EQ(some.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(all[i], some[i]);
}

TEST(Packing, NothingFitsIntoASmallBox) { EXPECT_TRUE(pack_lattice({}, Bounds{{0, 0, 0}, {0.9, 4, 4}}).empty()); }

TEST(Packing, SpacingKeepsSpheresApart) {
  const auto points = pack_lattice({Lattice::Kind::hcp, 1, 1.1}, {3, 3, 3}, Vec3::Zero());
  EXPECT_EQ(contacts_of(points, 13, 1.1), 12);
}

TEST(Packing, JitterIsSmallAndRepeats) {
  const auto still = pack_lattice({}, {3, 3, 3}, Vec3::Zero());
  auto a = still, b = still, c = still;
  jitter(a, 0.01, 5);
  jitter(b, 0.01, 5);
  jitter(c, 0.01, 6);
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE((a[i] - still[i]).cwiseAbs().maxCoeff(), 0.01);
}

TEST(Packing, RandomSpheresNeverOverlapNorLeaveTheBox) {
  const Bounds box{{0, 0, 0}, {10, 8, 6}};
  Random random(3);
  std::vector<double> radii;
  for (int i = 0; i < 600; ++i) radii.push_back(random.uniform(0.1, 0.5));
  const auto centres = pack_random(box, radii, 11);
  ASSERT_TRUE(centres);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    EXPECT_GE(((*centres)[i] - box.min).minCoeff(), radii[i]);
    EXPECT_GE((box.max - (*centres)[i]).minCoeff(), radii[i]);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(((*centres)[i] - (*centres)[j]).norm(), radii[i] + radii[j]);
    }
  }
  EXPECT_EQ(*centres, *pack_random(box, radii, 11));
  EXPECT_NE(*centres, *pack_random(box, radii, 12));
}

TEST(Packing, RandomGivesUpWhenTheBoxIsFull) {
  const std::vector<double> many(100, 0.5);
  EXPECT_FALSE(pack_random({{0, 0, 0}, {3, 3, 3}}, many, 1));
  EXPECT_FALSE(pack_random({{0, 0, 0}, {0.5, 3, 3}}, std::vector<double>{0.5}, 1));
  EXPECT_TRUE(pack_random({{0, 0, 0}, {1, 1, 1}}, std::vector<double>{}, 1));
}

TEST(Random, IsTheSameEverywhere) {
  Random random(42);
  EXPECT_EQ(random.uniform(0, 1), 0.75515553295453897);
  EXPECT_EQ(mixed(0), 0xe220a8397b1dcdafu);
}

TEST(Random, NormalNumbersHaveMeanZeroAndSpreadOne) {
  double sum = 0, squares = 0;
  const std::uint32_t count = 20000;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = normal_of(1, i, i + 1);
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / count, 0, 0.03);
  EXPECT_NEAR(squares / count, 1, 0.05);
}

TEST(Random, OrientationsAreUnitQuaternions) {
  Random random(1);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(random.orientation().norm(), 1, 1e-14);
}

}  // namespace
}  // namespace moraine
