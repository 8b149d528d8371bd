// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/bonds.hpp"

#include <gtest/gtest.h>

#include "scene_text.hpp"

namespace moraine {
namespace {

const std::string heap_of_sizes = R"(
materials: {m: {density: 1000}}
elements: [{packing: random, shape: {sphere: {uniform: [0.2, 0.5]}}, box: [[0,0,0],[5,5,5]], count: 200, id_start: 10}]
bonds: {between: touching, tolerance: 0.2, stiffness: 3, damping: 2, break_length: {mean: 1.1, spread: 0.02, seed: 4}}
time: {dt: 0.1, steps: 1}
)";

TEST(Bonds, TouchingPairsAreThoseOfBruteForce) {
  const Scene scene = scene_of(heap_of_sizes);
  std::vector<std::pair<ElementId, ElementId>> expected;
  for (const Element& a : scene.elements) {
    for (const Element& b : scene.elements) {
      const double radii = scene.shape_of(a).bounding_radius + scene.shape_of(b).bounding_radius;
      const double distance = (a.state.pose.position - b.state.pose.position).norm();
      if (a.id < b.id && distance - radii <= 0.2 * radii) expected.emplace_back(a.id, b.id);
    }
  }
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(touching_pairs(scene, 0.2), expected);
  ASSERT_EQ(scene.bonds.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::pair(scene.bonds[i].a, scene.bonds[i].b), expected[i]);
  }
}

TEST(Bonds, RestLengthIsTheDistanceAndBreakLengthVariesAboutItsMean) {
  const Scene scene = scene_of(heap_of_sizes);
  double sum = 0;
  for (const Bond& bond : scene.bonds) {
    const Vec3 a = find_element(scene.elements, bond.a)->state.pose.position;
    const Vec3 b = find_element(scene.elements, bond.b)->state.pose.position;
    EXPECT_DOUBLE_EQ(bond.rest_length, (a - b).norm());
    EXPECT_EQ(bond.stiffness, 3);
    EXPECT_EQ(bond.damping, 2);
    const double ratio = bond.break_length / bond.rest_length;
    EXPECT_GE(ratio, 1.01 - 1e-12);
    sum += ratio;
  }
  EXPECT_NEAR(sum / static_cast<double>(scene.bonds.size()), 1.1, 0.01);
}

TEST(Bonds, ABreakLengthBelongsToItsPair) {
  const BreakLength law{1.02, 0.01, 7};
  EXPECT_EQ(law.of(3, 4), law.of(3, 4));
  EXPECT_NE(law.of(3, 4), law.of(3, 5));
  EXPECT_NE(law.of(3, 4), (BreakLength{1.02, 0.01, 8}).of(3, 4));
  EXPECT_EQ((BreakLength{1.02, 0, 7}).of(3, 4), 1.02);
}

TEST(Bonds, ListedBondsAreSortedAndMayLastForEver) {
  const Scene scene = scene_of(R"(
materials: {m: {density: 1}}
elements: [{packing: list, shape: {sphere: 1}, items: [{at: [0,0,0]}, {at: [3,0,0]}, {at: [6,0,0]}]}]
bonds: [{a: 2, b: 1, stiffness: 1}, {a: 0, b: 1, stiffness: 2, break_length: 1.5}]
time: {dt: 1, steps: 1}
)");
  ASSERT_EQ(scene.bonds.size(), 2u);
  EXPECT_EQ(scene.bonds[0].a, 0u);
  EXPECT_EQ(scene.bonds[0].break_length, 4.5);
  EXPECT_EQ(scene.bonds[1].a, 1u);
  EXPECT_EQ(scene.bonds[1].b, 2u);
  EXPECT_TRUE(std::isinf(scene.bonds[1].break_length));
}

TEST(Bonds, HcpBlocksAreBondedToTwelveNeighboursInside) {
  const Scene scene = scene_of(R"(
materials: {m: {density: 1}}
elements: [{packing: hcp, shape: {sphere: 0.5}, cells: [5, 5, 5]}]
bonds: {between: touching, stiffness: 1}
time: {dt: 1, steps: 1}
)");
  const auto of_middle =
      std::count_if(scene.bonds.begin(), scene.bonds.end(), [](const Bond& b) { return b.a == 62 || b.b == 62; });
  EXPECT_EQ(of_middle, 12);
}

}  // namespace
}  // namespace moraine
