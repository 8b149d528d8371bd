// SPDX-License-Identifier: Apache-2.0
// Which balls are near each other and near walls, against looking at all of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "physics/native/verlet_list.hpp"
#include "physics/native/walls.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine::native {
namespace {

std::vector<Ball> cloud(std::size_t count, double smallest, double largest, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-10, 10), size(std::log(smallest), std::log(largest));
  std::vector<Ball> balls;
  for (std::size_t i = 0; i < count; ++i)
    balls.push_back({Vec3(place(random), place(random), place(random)), std::exp(size(random))});
  return balls;
}

class ListOfBalls : public testing::TestWithParam<double> {};

TEST_P(ListOfBalls, HoldsAllNearPairsInOrder) {
  const double skin = 0.1;
  const std::vector<Ball> balls = cloud(600, 1 / GetParam(), 1, 3);
  std::vector<std::uint8_t> passive(balls.size());
  for (std::size_t i = 0; i < balls.size(); i += 3) passive[i] = 1;
  SizedGrid grid;
  VerletList list;
  for (int again = 0; again < 2; ++again) {
    grid.build(balls, skin);
    list.build(grid, balls, passive, skin);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> listed, wanted;
  for (std::size_t k = 0; k < list.size(); ++k) listed.emplace_back(list.lower()[k], list.higher()[k]);
  for (std::uint32_t i = 0; i < balls.size(); ++i)
    for (std::uint32_t j = i + 1; j < balls.size(); ++j)
      if (!(passive[i] && passive[j]) &&
          (balls[i].centre - balls[j].centre).norm() < balls[i].radius + balls[j].radius + skin)
        wanted.emplace_back(i, j);
  EXPECT_EQ(listed, wanted);
  ASSERT_GT(wanted.size(), 10U);
  for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_EQ(list.find(wanted[k].first, wanted[k].second), k);
  EXPECT_EQ(list.find(0, 3), list.size()) << "two passive ones";
}

INSTANTIATE_TEST_SUITE_P(SizeRatio, ListOfBalls, testing::Values(1.0, 1.9, 30.0, 1000.0));

const std::string walls = R"(
materials: {m: {density: 1}}
boundaries:
  - {plane: {point: [0, 0, -9], normal: [0, 0.6, 0.8]}}
  - {box: [[-8, -8, -8], [8, 8, 8]], triangulated: true}
  - {plate: {size: [1, 2, 3], at: [1, 2, 3]}, kinematic: true, motion: {velocity: [1, 0, 0], angular_velocity: [0, 0, 1]}}
  - {solid: {capsule: {radius: 1, length: 4}}, at: [-3, 2, 1], rotation: {axis: [1, 0, 0], angle: 40}}
  - {solid: {hull: {points: [[0,0,0], [2,0,0], [0,2,0], [0,0,2]]}}, at: [4, -4, 0]}
  - {solid: {compound: [{sphere: 1}, {box: [1, 1, 4], at: [1, 0, 0]}]}, at: [-5, -5, -5]}
  - {plane: {point: [0, 0, 9], normal: [0, 0, -1]}, kinematic: true, motion: {angular_velocity: [0.1, 0, 0]}}
time: {dt: 1, steps: 1}
)";

TEST(WallsAndBalls, CandidatesAreAllThatAreNear) {
  const double skin = 0.2;
  const Scene scene = scene_of(walls);
  const std::vector<Ball> balls = cloud(800, 0.2, 1, 5);
  const std::vector<std::uint8_t> passive(balls.size());
  Walls all(scene);
  all.move(0.7);
  SizedGrid grid;
  grid.build(balls, skin);
  std::vector<WallCandidate> found, wanted;
  all.find(grid, balls, passive, skin, found);
  for (std::uint32_t i = 0; i < balls.size(); ++i)
    for (std::uint32_t w = 0; w < all.size(); ++w)
      for (std::uint32_t s = 0; s < all[w].surfaces(); ++s)
        if (all[w].sweeps() || all[w].nearest(s, balls[i].centre).distance < balls[i].radius + skin)
          wanted.push_back({i, w, s});
  EXPECT_EQ(found, wanted);
  EXPECT_GT(wanted.size(), 900U);
  EXPECT_EQ(all.moved(), 0);
  all.move(0.8);
  EXPECT_GE(all.moved(), 0.1) << "the plate's speed is 1 m/s, its rim's more";
  EXPECT_LT(all.moved(), 0.5);
}

/// Moved to the point that nearest() gives, a ball's centre is on the surface, and there is no nearer point around.
TEST(WallsAndBalls, NearestPointIsNearest) {
  const Scene scene = scene_of(walls);
  const Walls all(scene);
  std::mt19937 random(7);
  std::normal_distribution<double> step(0, 0.3);
  for (const Ball& ball : cloud(200, 1, 1, 9))
    for (std::size_t w = 0; w < all.size(); ++w)
      for (std::size_t s = 0; s < all[w].surfaces(); ++s) {
        const Nearest n = all[w].nearest(s, ball.centre);
        ASSERT_NEAR(n.normal.norm(), 1, 1e-12);
        ASSERT_LT((n.point + n.distance * n.normal - ball.centre).norm(), 1e-9);
        ASSERT_NEAR(all[w].nearest(s, n.point).distance, 0, 1e-9);
        if (n.distance <= 0) continue;
        const Vec3 elsewhere = n.point + Vec3(step(random), step(random), step(random));
        const Nearest other = all[w].nearest(s, elsewhere);
        ASSERT_GE((other.point - ball.centre).norm(), n.distance - 1e-9);
      }
}

TEST(WallsAndBalls, InsideABlockTheNearestFaceIsTheWayOut) {
  const Scene scene = scene_of(
      "materials: {m: {density: 1}}\nboundaries: [{plate: {size: [2, 4, 6], at: [1, 1, 1]}}]\n"
      "time: {dt: 1, steps: 1}\n");
  const Nearest n = Walls(scene)[0].nearest(0, Vec3(1.7, 1, 1));
  EXPECT_EQ(n.normal, Vec3(1, 0, 0));
  EXPECT_NEAR(n.distance, -0.3, 1e-15);
  EXPECT_EQ(n.point, Vec3(2, 1, 1));
}

/// On the seam of two triangles of a floor there is one contact; in the corner of a container there are three.
TEST(WallsAndBalls, SeamsOfAMeshAreNotTouchedTwice) {
  const Scene scene = scene_of(
      "materials: {m: {density: 1}}\nboundaries: [{box: [[0, 0, 0], [4, 4, 4]], triangulated: "
      "true}]\ntime: {dt: 1, steps: 1}\n");
  Walls all(scene);
  const auto touches = [&](const Vec3& centre) {
    const std::vector<Ball> balls{{centre, 0.5}};
    SizedGrid grid;
    grid.build(balls, 0.1);
    std::vector<WallCandidate> candidates;
    all.find(grid, balls, std::vector<std::uint8_t>{0}, 0.1, candidates);
    std::vector<Nearest> out;
    find_touches(all[0], balls[0], candidates, out);
    return out;
  };
  for (const Vec3& centre : {Vec3(2, 2, 0.45), Vec3(1.3, 1.3, 0.4), Vec3(2.1, 1.9, 0.45)}) {
    const std::vector<Nearest> floor = touches(centre);
    ASSERT_EQ(floor.size(), 1U) << centre.transpose();
    EXPECT_NEAR(floor[0].normal.z(), 1, 1e-12);
    EXPECT_NEAR(floor[0].distance, centre.z(), 1e-12);
  }
  EXPECT_EQ(touches(Vec3(0.45, 0.47, 0.48)).size(), 3U);
  EXPECT_EQ(touches(Vec3(2, 2, 2)).size(), 0U);
}

}  // namespace
}  // namespace moraine::native
