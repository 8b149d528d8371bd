// SPDX-License-Identifier: Apache-2.0
// Boundaries that turn, push and consist of parts.
#include <gtest/gtest.h>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::ModelRun;
using test::set;
using test::spheres;
using test::weightless;

/// On a plane that turns about the world's z axis the surface moves across the arm, wherever the sub-model's origin is.
TEST(Boundaries, ATurningPlaneCarriesWhatLiesOnIt) {
  const std::string scene = spheres("{id: 1, at: [4, 0, 0.1]}", "restitution: 0, friction: 0.5",
                                    "boundaries: [{plane: {normal: [0, 0, 1]}, kinematic: true, motion: "
                                    "{angular_velocity: [0, 0, 1]}}]\n");
  for (const char* engine : {"bullet", "bullet64", "impulse", "ode"}) {
    ModelRun run(scene_of(scene, {set("run.engine", std::string(engine)), set("time.steps", 50)}));
    run.go();
    const Vec3 v = run.velocity(1);
    EXPECT_GT(v.norm(), 0.1) << engine;
    EXPECT_GT(v.normalized().dot(Vec3(0, 1, 0)), 0.99) << engine << ": " << v.transpose();
  }
}

/// A plate pushes one sphere into another that is four diameters away in the other sub-model, within an epoch.
TEST(Boundaries, WhatIsPushedMeetsWhatWasFarAway) {
  const std::string scene = spheres("{id: 1, at: [0, 0, 0]}, {id: 2, at: [0.8, 0, 0]}", "restitution: 0",
                                    weightless +
                                        "boundaries: [{plate: {size: [0.2, 2, 2], at: [-0.21, 0, 0]}, kinematic: true, "
                                        "motion: {velocity: [4, 0, 0]}}]\nrun: {sub_models: 2, split: slabs}\n");
  for (const char* engine : {"bullet", "impulse"}) {
    ModelRun run(scene_of(scene, {set("run.engine", std::string(engine)), set("dt", 4e-3), set("time.steps", 60)}));
    run.go();
    EXPECT_GT(run.velocity(2).x(), 1) << engine;
  }
}

/// One boundary of a hull and a box, each under an element of its own.
TEST(Boundaries, CompoundsOfHullsAndOthersCarry) {
  const std::string hull =
      "{hull: {points: [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 0], [1, -1, 0], [1, 1, 0], "
      "[-1, 1, 0]]}, at: [-2, 0, 0]}";
  const std::string box = "{box: [2, 2, 2], at: [2, 0, -1]}";
  for (const std::string& parts : {hull + ", " + box, box + ", " + hull})
    for (const char* shape : {"{box: [0.2, 0.2, 0.2]}", "{sphere: 0.1}"})
      for (const char* engine : {"bullet", "ode"}) {
        const std::string scene = fmt::format(R"(
materials: {{ball: {{density: 1000, friction: 0.5}}}}
elements:
  - {{packing: list, shape: {}, items: [{{id: 1, at: [-2, 0, 0.11]}}, {{id: 2, at: [2, 0, 0.11]}}]}}
boundaries: [{{solid: {{compound: [{}]}}}}]
time: {{dt: 2e-3, steps: 200}}
run: {{engine: {}}}
)",
                                              shape, parts, engine);
        ModelRun run(scene_of(scene));
        run.go();
        for (const ElementId id : {1, 2}) EXPECT_NEAR(run.position(id).z(), 0.1, 5e-3) << engine << shape << id;
      }
}

}  // namespace
}  // namespace moraine
