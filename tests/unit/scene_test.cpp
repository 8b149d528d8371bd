// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/scene.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "scene_text.hpp"

namespace moraine {
namespace {

const std::filesystem::path scenes = std::filesystem::path(MORAINE_SOURCE_DIR) / "apps/scenes";

const std::string minimal = R"(
parameters: {radius: 0.5, diameter: 2 * radius, speed: -3}
materials: {rock: {density: 6 / pi}}
elements:
  - {packing: list, shape: {sphere: radius}, items: [{at: [diameter, 0, 0], velocity: [speed, 0, 0]}]}
time: {dt: 0.1, duration: 1}
)";

TEST(SceneFiles, EveryExampleReadsAndHoldsWhatItSays) {
  const std::map<std::string, std::size_t> counts = {{"bonded_beam", 108}, {"box_settle", 432},    {"column", 50},
                                                     {"crust", 97038},     {"crust_small", 10000}, {"dam", 10000},
                                                     {"heap", 5000},       {"mixed_shapes", 800},  {"two_spheres", 2}};
  std::set<std::string> seen;
  for (const auto& file : std::filesystem::directory_iterator(scenes)) {
    if (file.path().extension() != ".yaml") continue;
    SCOPED_TRACE(file.path().string());
    const std::string name = file.path().stem();
    const Scene scene = read_scene(file.path());
    if (const auto expected = counts.find(name); expected != counts.end()) {
      EXPECT_EQ(scene.elements.size(), expected->second);
      seen.insert(name);
    }
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_GT(scene.time.steps, 0);
    for (std::size_t i = 1; i < scene.elements.size(); ++i) {
      ASSERT_LT(scene.elements[i - 1].id, scene.elements[i].id);
    }
  }
  EXPECT_EQ(seen.size(), counts.size());
}

TEST(SceneFiles, CrustIsSixSubModelsOfTouchingBondedSpheresBeforeAPlate) {
  const Scene scene = read_scene(scenes / "crust.yaml");
  EXPECT_EQ(scene.run.sub_models, 6);
  EXPECT_EQ(scene.time.steps, 120);
  EXPECT_EQ(scene.time.label.unit, "year");
  EXPECT_EQ(scene.time.label.per_step, 10);
  EXPECT_FALSE(scene.materials.any_friction());
  EXPECT_GT(scene.bonds.size(), 5 * scene.elements.size());
  Bounds block;
  for (const Element& e : scene.elements) block.add(e.state.pose.position, scene.shape_of(e).bounding_radius);
  EXPECT_GT(block.max.x(), 99e3);
  EXPECT_GT(block.max.y(), 59e3);
  EXPECT_GT(block.max.z(), 28e3);
  ASSERT_EQ(scene.boundaries.size(), 2u);
  EXPECT_EQ(std::get<TriangleMesh>(scene.boundaries[0].geometry).triangles.size(), 12u);
  const Boundary& plate = scene.boundaries[1];
  const double moved = plate.motion.pose(plate.pose, 60).position.x() - plate.pose.position.x();
  EXPECT_NEAR(moved, -2 * scene.typical_diameter(), 1);
}

TEST(SceneFiles, DamHasUnitSpheresAndScalesWithItsCount) {
  const Scene dam = read_scene(scenes / "dam.yaml");
  EXPECT_DOUBLE_EQ(dam.typical_diameter(), 1);
  EXPECT_NEAR(dam.typical_mass(), 1, 1e-12);
  EXPECT_EQ(dam.time.steps, 522);
  for (const char* count : {"1", "1000", "100000"}) {
    const Scene other = read_scene(scenes / "dam.yaml", {{"count", count}});
    EXPECT_EQ(other.elements.size(), std::stoul(count));
    for (const Element& e : other.elements) {
      for (const Boundary& b : other.boundaries) {
        const Plane& plane = std::get<Plane>(b.geometry);
        ASSERT_GE(plane.normal.dot(e.state.pose.position - plane.point), 0.5);
      }
    }
  }
}

TEST(SceneFiles, TheFirstExampleOfTheReferenceReads) {
  std::ifstream in(std::filesystem::path(MORAINE_SOURCE_DIR) / "docs/scenes.md");
  const std::string page((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string fence = "```yaml\n";
  const auto begin = page.find(fence) + fence.size();
  EXPECT_EQ(scene_of(page.substr(begin, page.find("```", begin) - begin)).elements.size(), 500u);
}

TEST(Scene, ExpressionsUseParametersAndConstants) {
  const Scene scene = scene_of(minimal);
  ASSERT_EQ(scene.elements.size(), 1u);
  const Element& e = scene.elements[0];
  EXPECT_EQ(e.id, 0u);
  EXPECT_NEAR(e.mass, 1, 1e-12);
  EXPECT_EQ(e.state.pose.position.x(), 1);
  EXPECT_EQ(e.state.twist.linear.x(), -3);
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(scene.time.steps, 10);
  EXPECT_EQ(scene.time.substeps, 1);
}

TEST(Scene, OverridesSetParametersFirstAndPathsOtherwise) {
  const Scene scene = scene_of(minimal, {{"radius", "2"},
                                         {"run.engine", "ode"},
                                         {"elements.0.items.0.velocity", "[7, radius, 0]"},
                                         {"gravity", "[0, 0, 0]"},
                                         {"time.substeps", "4"},
                                         {"materials.rock.friction", "radius / 4"}});
  EXPECT_EQ(scene.elements[0].state.pose.position.x(), 4);
  EXPECT_EQ(scene.elements[0].state.twist.linear, Vec3(7, 2, 0));
  EXPECT_EQ(scene.run.engine, "ode");
  EXPECT_TRUE(scene.gravity.isZero());
  EXPECT_EQ(scene.time.substeps, 4);
  EXPECT_EQ(scene.materials.materials[0].friction, 0.5);
}

TEST(Scene, TheLastOfStepsAndDurationCounts) {
  EXPECT_EQ(scene_of(minimal, {{"time.steps", "3"}}).time.steps, 3);
  EXPECT_EQ(scene_of(minimal, {{"time.steps", "3"}, {"time.duration", "0.5"}}).time.steps, 5);
  EXPECT_EQ(scene_of(minimal, {{"time.dt", "0.05"}}).time.steps, 20);
}

TEST(Scene, SettingsAreTheDefaultsUnlessStated) {
  const Scene plain = scene_of(minimal);
  EXPECT_EQ(plain.run.engine, RunSettings{}.engine);
  EXPECT_EQ(plain.run.sub_models, 0);
  EXPECT_EQ(plain.output.formats, OutputSettings{}.formats);
  const Scene set = scene_of(minimal + R"(
run: {sub_models: auto, split: slabs, coupling: none, coupling_leak: 0.5, skin: 0.1, recut_ghost_share: 0.4,
      iterations: 7, scheduler: serial, threads: 2, max_speed: 3,
      engine_profile: physx, engine: ode, skip_threshold: 0.01}
output: {folder: here, quiet: true, every: 3, formats: [csv, vtkhdf], pictures: no, picture_width: 300}
)");
  EXPECT_EQ(set.run.sub_models, 0);
  EXPECT_EQ(set.run.split, "slabs");
  EXPECT_EQ(set.run.coupling_leak, 0.5);
  EXPECT_EQ(set.run.iterations, 7);
  EXPECT_EQ(set.run.skip_threshold, 0.01);
  EXPECT_EQ(set.run.engine_profile, "physx");
  EXPECT_EQ(set.output.formats, (std::vector<std::string>{"csv", "vtkhdf"}));
  EXPECT_EQ(set.output.folder, "here");
  EXPECT_TRUE(set.output.quiet);
  EXPECT_FALSE(set.output.pictures);
  EXPECT_EQ(set.output.picture_width, 300);
}

TEST(Scene, NoElementsIsAWarning) {
  const Scene scene = scene_of("time: {dt: 1, steps: 1}");
  EXPECT_TRUE(scene.elements.empty());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.typical_diameter(), 1);
  EXPECT_EQ(scene.typical_mass(), 1);
}

TEST(Scene, PairsAreGeometricMeansUnlessStated) {
  const Scene scene = scene_of(R"(
materials: {a: {density: 1, friction: 0.9, restitution: 0.4}, b: {density: 1, friction: 0.4, restitution: 0.9}}
material_pairs: [{between: [b, a], restitution: 0.1}]
time: {dt: 1, steps: 1}
)");
  EXPECT_DOUBLE_EQ(scene.materials.pair(0, 0).friction, 0.9);
  EXPECT_DOUBLE_EQ(scene.materials.pair(0, 1).friction, 0.6);
  EXPECT_DOUBLE_EQ(scene.materials.pair(0, 1).restitution, 0.1);
  EXPECT_DOUBLE_EQ(scene.materials.pair(1, 0).restitution, 0.1);
  EXPECT_TRUE(scene.materials.any_friction());
  EXPECT_TRUE(scene.materials.any_restitution());
}

TEST(Scene, IdsContinueAndElementsAscend) {
  const Scene scene = scene_of(R"(
materials: {a: {density: 1}}
elements:
  - {packing: list, shape: {sphere: 1}, items: [{at: [0, 0, 0], id: 7}, {at: [3, 0, 0]}, {at: [6, 0, 0], id: 2}]}
  - {packing: cubic, shape: {sphere: 1}, cells: [2, 1, 1], at: [0, 5, 0]}
  - {packing: cubic, shape: {sphere: 1}, cells: [1, 1, 1], at: [0, 9, 0], id_start: 4, mass: 12}
time: {dt: 1, steps: 1}
)");
  std::vector<ElementId> ids;
  for (const Element& e : scene.elements) ids.push_back(e.id);
  EXPECT_EQ(ids, (std::vector<ElementId>{2, 4, 7, 8, 9, 10}));
  EXPECT_EQ(scene.elements[1].mass, 12);
  EXPECT_EQ(scene.shapes.size(), 1u);
}

TEST(Scene, ElementsWithShapesOffTheirOriginArePlacedByTheFrameTheyWereWrittenIn) {
  const Scene scene = scene_of(R"(
materials: {a: {density: 1}}
elements:
  - packing: list
    shape: {compound: [{sphere: 1, at: [2, 0, 0]}, {sphere: 1, at: [4, 0, 0]}]}
    items: [{at: [10, 0, 0], rotation: {axis: [0, 0, 1], angle: 90}}]
time: {dt: 1, steps: 1}
)");
  EXPECT_LE((scene.elements[0].state.pose.position - Vec3(10, 3, 0)).norm(), 1e-12);
}

TEST(Scene, BoundariesOfEveryKind) {
  const Scene scene = scene_of(R"(
materials: {a: {density: 1}}
boundaries:
  - {plane: {normal: [0, 0, 2]}}
  - {box: [[0, 0, 0], [2, 4, 6]]}
  - {box: [[0, 0, 0], [2, 4, 6]], open_top: true}
  - {box: [[0, 0, 0], [2, 4, 6]], triangulated: true, open_top: true}
  - {mesh: {vertices: [[0,0,0], [1,0,0], [0,1,0]], triangles: [[0, 1, 2]]}, at: [1, 2, 3]}
  - {solid: {capsule: {radius: 1, length: 2}}, at: [5, 5, 5]}
  - {plate: {size: [1, 2, 3], at: [7, 7, 7]}, kinematic: true, motion: {velocity: [1, 0, 0]}}
time: {dt: 1, steps: 1}
)");
  ASSERT_EQ(scene.boundaries.size(), 1u + 6 + 5 + 4);
  EXPECT_EQ(std::get<Plane>(scene.boundaries[0].geometry).normal, Vec3::UnitZ());
  for (std::size_t i = 1; i < 12; ++i) {  // the middle is inside
    const Plane& plane = std::get<Plane>(scene.boundaries[i].geometry);
    EXPECT_GT(plane.normal.dot(Vec3(1, 2, 3) - plane.point), 0);
  }
  const Boundary& open = scene.boundaries[12];
  const TriangleMesh& mesh = std::get<TriangleMesh>(open.geometry);
  EXPECT_EQ(mesh.triangles.size(), 10u);
  for (const auto& t : mesh.triangles) {  // wound to face the middle, which is the mesh's origin
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    EXPECT_LT((b - a).cross(c - a).dot(a), 0);
  }
  EXPECT_EQ(open.pose.position, Vec3(1, 2, 3));
  EXPECT_EQ(scene.boundaries[13].pose.position, Vec3(1, 2, 3));
  EXPECT_TRUE(std::holds_alternative<Solid>(scene.boundaries[14].geometry));
  EXPECT_TRUE(scene.boundaries[15].motion.moves());
}

TEST(Motion, TravelsTheStatedDistanceWithItsRamps) {
  Motion m;
  m.velocity.linear = {2, 0, 0};
  m.start = 1;
  m.stop = 6;
  m.ramp = 2;
  EXPECT_EQ(m.pose({}, 0.5).position.x(), 0);
  EXPECT_NEAR(m.pose({}, 100).position.x(), 2 * (6 - 1 - 2), 1e-12);
  EXPECT_EQ(m.twist({}, 0.5).linear.x(), 0);
  EXPECT_NEAR(m.twist({}, 2).linear.x(), 1, 1e-12);
  EXPECT_NEAR(m.twist({}, 3.5).linear.x(), 2, 1e-12);
  EXPECT_EQ(m.twist({}, 7).linear.x(), 0);
}

TEST(Motion, VelocityIsTheDerivativeOfThePose) {
  Motion m;
  m.velocity = {{0.3, -0.2, 0.1}, {0.5, 1, -0.4}};
  m.centre = {1, 2, 3};
  m.stop = 5;
  m.ramp = 1;
  const Pose initial{{4, 4, 4}, Quat::Identity()};
  const double h = 1e-6;
  for (double t = 0.3; t < 5; t += 0.5) {
    const Vec3 slope = (m.pose(initial, t + h).position - m.pose(initial, t - h).position) / (2 * h);
    EXPECT_LE((m.twist(initial, t).linear - slope).norm(), 1e-7) << t;
  }
}

TEST(Motion, AQuarterTurnIsAQuarterTurn) {
  Motion m;
  m.velocity.angular = {0, 0, std::numbers::pi / 2};
  m.centre = {1, 0, 0};
  const Pose end = m.pose({{2, 0, 0}, Quat::Identity()}, 1);
  EXPECT_LE((end.position - Vec3(1, 1, 0)).norm(), 1e-12);
  EXPECT_LE((end.orientation * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
}

}  // namespace
}  // namespace moraine
