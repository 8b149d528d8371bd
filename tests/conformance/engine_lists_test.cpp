// SPDX-License-Identifier: Apache-2.0
// Engines may keep lists of what is near for many steps; nothing may depend on when they were made.
#include <gtest/gtest.h>

#include "tests/support/engine_scenes.hpp"
#include "tests/support/model_run.hpp"
#include "tests/support/single_world.hpp"

namespace moraine {
namespace {

using test::SingleWorld;

/// Fast balls, large and small, in a closed box, of which one end comes inwards.
std::string flights() {
  return test::balls(
      "{id: 1, at: [1, 1, 1], velocity: [20, 3, 1]}, {id: 2, at: [3, 2, 2], velocity: [-9, 14, 5]}, "
      "{id: 3, at: [5, 3, 3], velocity: [2, -11, -13]}, {id: 4, at: [7, 1, 3], velocity: [-1, 0.5, 0.2]}, "
      "{id: 5, at: [2, 3.2, 3], velocity: [0, 0, 0]}, {id: 6, at: [6, 2, 1], velocity: [12, 12, -12]}",
      "boundaries: [{box: [[0, 0, 0], [8, 4, 4]]}, {plate: {size: [0.5, 4, 4], at: [-0.5, 2, 2]}, kinematic: true, "
      "motion: {velocity: [1, 0, 0], stop: 1}}]\n",
      ", friction: 0.3, restitution: 0.9");
}

class EngineLists : public testing::TestWithParam<std::string> {};

/// The world that is loaded before every step has to list everything anew.
TEST_P(EngineLists, NeverMatter) {
  const Engine& engine = find_engine(GetParam());
  SingleWorld stays(engine, scene_of(flights()));
  std::vector<std::byte> image;
  for (int step = 0; step < 200; ++step) {
    stays.world().canonicalise();
    image.clear();
    stays.world().save(image);
    SingleWorld anew(engine, stays);
    anew.world().load(image);
    stays.steps(1);
    anew.steps(1);
    for (const ElementId id : stays.ids())
      ASSERT_TRUE(test::same_bits(stays.state(id), anew.state(id))) << "element " << id << ", step " << step;
  }
  EXPECT_GT(stays.given().linear.norm(), 10) << "walls were hit";
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Engine& e : engines()) all.emplace_back(e.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(All, EngineLists, testing::ValuesIn(names()), [](const auto& c) { return c.param; });

}  // namespace
}  // namespace moraine
