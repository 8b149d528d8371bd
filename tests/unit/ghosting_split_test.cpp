// SPDX-License-Identifier: Apache-2.0
// How a scene is cut and into how many parts.
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "ghosting/auto_count.hpp"
#include "ghosting/split.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using Owners = std::vector<SubModelId>;
const Vec3 down(0, 0, -9.81);

std::vector<std::string> split_names() {
  std::vector<std::string> names;
  for (const SplitRow& row : splits()) names.emplace_back(row.name);
  return names;
}

std::vector<Vec3> cloud(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < n; ++i) points.emplace_back(9 * u(random), 4 * u(random), 2 * u(random));
  return points;
}

std::vector<Vec3> grid(int nx, int ny, int nz) {
  std::vector<Vec3> points;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) points.emplace_back(x, y, z);
  return points;
}

std::vector<std::size_t> sizes(const Owners& owners, std::size_t parts) {
  std::vector<std::size_t> count(parts, 0);
  for (const SubModelId p : owners) ++count.at(p);
  return count;
}

class EverySplit : public testing::TestWithParam<std::string> {
 protected:
  Owners split(const std::vector<Vec3>& points, std::size_t parts) const {
    for (const SplitRow& row : splits())
      if (row.name == GetParam()) return row.split({points, down, parts});
    return {};
  }
};

TEST_P(EverySplit, GivesEveryElementToOnePartAndPartsAreEven) {
  for (const std::size_t n : {0U, 1U, 2U, 7U, 100U, 1000U, 4097U})
    for (const std::size_t parts : {1U, 2U, 3U, 5U, 7U, 16U, 33U}) {
      const Owners owners = split(cloud(n, static_cast<unsigned>(n)), parts);
      ASSERT_EQ(owners.size(), n);
      const auto count = sizes(owners, parts);
      const auto [least, most] = std::minmax_element(count.begin(), count.end());
      EXPECT_LE(*most - *least, 1U) << n << " elements in " << parts;
    }
}

TEST_P(EverySplit, EqualPlacesAreEvenToo) {
  const auto count = sizes(split(std::vector<Vec3>(100, Vec3(1, 2, 3)), 7), 7);
  EXPECT_EQ(*std::min_element(count.begin(), count.end()), 14U);
  EXPECT_EQ(*std::max_element(count.begin(), count.end()), 15U);
}

TEST_P(EverySplit, DependsOnPlacesAndNotOnTheirOrder) {
  const std::vector<Vec3> points = cloud(1000, 3);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  std::vector<Vec3> shuffled;
  for (const std::size_t i : order) shuffled.push_back(points[i]);
  const Owners plain = split(points, 7), other = split(shuffled, 7);
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(other[k], plain[order[k]]);
}

TEST_P(EverySplit, DoesNotDependOnPlaceOrSizeOfTheScene) {
  const std::vector<Vec3> points = cloud(500, 9);
  std::vector<Vec3> moved;
  for (const Vec3& p : points) moved.push_back(1024 * p + Vec3(4096, -8192, 1024));
  EXPECT_EQ(split(points, 6), split(moved, 6));
}

INSTANTIATE_TEST_SUITE_P(All, EverySplit, testing::ValuesIn(split_names()),
                         [](const auto& test) { return test.param; });

/// How many columns of a grid along z have elements in more than one part.
std::size_t cut_columns(const std::vector<Vec3>& points, const Owners& owners) {
  std::map<std::pair<double, double>, std::set<SubModelId>> parts;
  for (std::size_t i = 0; i < points.size(); ++i) parts[{points[i].x(), points[i].y()}].insert(owners[i]);
  return static_cast<std::size_t>(
      std::count_if(parts.begin(), parts.end(), [](const auto& p) { return p.second.size() > 1; }));
}

TEST(Pillars, KeepWhatStandsOnEachOtherTogether) {
  const std::vector<Vec3> points = grid(12, 6, 10);
  for (const std::size_t parts : {2U, 3U, 4U, 6U, 8U, 12U})
    EXPECT_EQ(cut_columns(points, split_pillars({points, down, parts})), 0U) << parts;
}

TEST(Pillars, FollowGravity) {
  std::vector<Vec3> points;
  for (const Vec3& p : grid(12, 6, 10)) points.emplace_back(p.z(), p.x(), p.y());
  const Owners owners = split_pillars({points, Vec3(-3, 0, 0), 4});
  std::vector<Vec3> turned;
  for (const Vec3& p : points) turned.emplace_back(p.y(), p.z(), p.x());
  EXPECT_EQ(cut_columns(turned, owners), 0U);
}

TEST(Slabs, FollowTheLongestAxis) {
  const std::vector<Vec3> points = grid(12, 6, 10);
  const Owners owners = split_slabs({points, down, 4});
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(owners[i], static_cast<SubModelId>(points[i].x()) / 3) << points[i].transpose();
}

TEST(Rcb, MakesCompactBoxes) {
  const std::vector<Vec3> points = grid(8, 8, 8);
  const Owners owners = split_rcb({points, down, 8});
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points.size(); ++j) {
      const bool same_octant = ((points[i].array() < 4) == (points[j].array() < 4)).all();
      ASSERT_EQ(owners[i] == owners[j], same_octant);
    }
}

TEST(SplitTable, ListsItselfIfAskedForAnother) {
  const Scene scene = test::example("column");
  try {
    find_split("thirds", scene, 3);
    FAIL();
  } catch (const InputError& e) {
    for (const SplitRow& row : splits()) EXPECT_NE(std::string(e.what()).find(row.name), std::string::npos) << row.name;
    EXPECT_NE(std::string(e.what()).find("auto"), std::string::npos);
  }
}

TEST(SplitTable, AutoTakesPillarsWhereTheyAreWideEnough) {
  EXPECT_EQ(find_split("auto", test::example("dam", {test::set("count", 4000)}), 4).name, "pillars");
  EXPECT_EQ(find_split("auto", test::example("column"), 5).name, "rcb") << "one diameter wide";
  EXPECT_EQ(find_split("auto", test::example("two_spheres"), 2).name, "rcb") << "no gravity";
}

const Engine& bullet() { return find_engine("bullet"); }

TEST(AutoCount, KeepsToTheLimitsOfPhysX) {
  const Limits limits = find_limits("physx");
  EXPECT_EQ(limits.packed_spheres(), 21'333U);
  EXPECT_EQ(limits.worlds, 64U);
  for (const std::size_t n : {1U, 1000U, 21'000U, 97'038U, 1'000'000U}) {
    const std::size_t parts = auto_count(n, bullet(), limits);
    const std::size_t largest = (n + parts - 1) / parts;
    EXPECT_LE(static_cast<double>(largest), 21'333 * 0.9) << n;
  }
  EXPECT_EQ(auto_count(1, bullet(), limits), 1U);
  EXPECT_EQ(auto_count(0, bullet(), limits), 1U);
}

TEST(AutoCount, GrowsWithTheScene) {
  std::size_t before = 1;
  for (std::size_t n = 1; n < 10'000'000; n = n * 5 / 4 + 1) {
    const std::size_t parts = auto_count(n, bullet(), {});
    EXPECT_GE(parts, before) << n;
    before = parts;
  }
  EXPECT_GT(before, 10U);
}

TEST(AutoCount, DoesNotLookAtCores) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  const std::size_t wide = auto_count(300'000, bullet(), {});
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const std::size_t narrow = auto_count(300'000, bullet(), {});
  EXPECT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(narrow, wide);
}

TEST(Limits, RefuseWhatDoesNotFit) {
  const auto model_of = [](const std::vector<Override>& overrides) {
    const Scene scene = test::example("column", overrides);
    CoupledModel{scene};
  };
  EXPECT_THROW(
      model_of({test::set("run.engine_profile", "physx"), test::set("run.sub_models", 65), test::set("count", 100)}),
      InputError);
  EXPECT_THROW(
      model_of({test::set("run.engine_profile", "physx"), test::set("run.sub_models", 1), test::set("count", 19'300)}),
      InputError);
  EXPECT_NO_THROW(model_of({test::set("run.engine_profile", "physx"), test::set("run.sub_models", 64)}));
  EXPECT_THROW(find_limits("cray"), InputError);
}

}  // namespace
}  // namespace moraine
