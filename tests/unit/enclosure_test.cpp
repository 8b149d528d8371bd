// SPDX-License-Identifier: Apache-2.0
// What an enclosure says of a box must hold for every point of it.
#include "ghosting/enclosure.hpp"

#include <gtest/gtest.h>

#include "tests/support/dice.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine {
namespace {

const char* ball =
    "gravity: [1, 2, -9]\nmaterials: {grain: {density: 1000}}\n"
    "elements: [{packing: list, shape: {sphere: 0.1}, items: [{id: 0, at: [0.1, 0, 0.2]}]}]\n"
    "time: {dt: 1e-3, steps: 1}\n";
const char* tilted_planes =
    "boundaries: [{plane: {point: [0, 0, -2], normal: [0.3, -0.2, 1]}}, {plane: {point: [0, 3, 0], normal: [0, -1, "
    "0.5]}}]\n";
const char* turned_mesh =
    "boundaries: [{mesh: {vertices: [[0, 0, 5], [5, -4, -4], [-5, -4, -4], [0, 6, -4]], triangles: [[0, 1, 2], [0, 2, "
    "3], "
    "[0, 3, 1], [1, 3, 2]]}, rotation: {axis: [1, 1, 0], angle: 30}}]\n";

Bounds around(const Vec3& middle, const Vec3& half) {
  Bounds box;
  for (const double sign : {-1.0, 1.0}) box.add(middle + sign * half.cwiseAbs());
  return box;
}

TEST(Enclosure, HoldsABoxOnlyIfItHoldsAllPointsOfIt) {
  for (const char* boundaries : {tilted_planes, turned_mesh}) {
    const Scene scene = scene_of(std::string(ball) + boundaries);
    const Enclosure enclosure(scene);
    const Vec3 start = scene.elements[0].state.pose.position;
    test::Dice dice(1);
    int held = 0;
    for (int k = 0; k < 500; ++k) {
      const Vec3 middle = dice.vec(3), half = dice.vec(1);
      if (!enclosure.holds(around(middle, half))) continue;
      ++held;
      for (int p = 0; p < 50; ++p) {
        const Vec3 point = middle + half.cwiseProduct(dice.vec(1));
        EXPECT_LE(enclosure.beyond(point, start), 1e-12) << boundaries << point;
        EXPECT_LE(enclosure.below(point), 1e-12) << boundaries << point;
      }
    }
    EXPECT_GT(held, 10) << boundaries;
    EXPECT_LT(held, 490) << boundaries;
  }
}

}  // namespace
}  // namespace moraine
