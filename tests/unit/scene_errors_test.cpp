// SPDX-License-Identifier: Apache-2.0
// What a wrong scene is answered with: the place, what is wrong, what was expected.
#include <gtest/gtest.h>

#include "scene_text.hpp"

namespace moraine {
namespace {

/// A scene of a materials line, an elements line and more.
std::string scene_with(const std::string& elements, const std::string& more = "", const std::string& density = "1000") {
  return "materials: {rock: {density: " + density + "}}\nelements:\n  - " + elements + "\ntime: {dt: 0.1, steps: 1}\n" +
         more;
}

const std::string one = "{packing: list, shape: {sphere: 1}, items: [{at: [0, 0, 0]}, {at: [3, 0, 0]}]}";

struct Wrong {
  const char* name;
  std::string text;
  std::string start;  ///< of the error text
};
void PrintTo(const Wrong& w, std::ostream* out) { *out << w.name; }

class SceneError : public testing::TestWithParam<Wrong> {};

TEST_P(SceneError, SaysWhereAndWhat) {
  const std::string error = error_of(GetParam().text);
  EXPECT_EQ(error.substr(0, GetParam().start.size()), GetParam().start) << error;
  EXPECT_NE(error.find("expected"), std::string::npos) << error;
}

const std::vector<Wrong> wrong_values = {
    {"negative_radius", scene_with("{packing: list, shape: {sphere: -1}, items: []}"),
     "scene.yaml:3:37: 'elements.0.shape.sphere' is -1, expected more than 0"},
    {"nan", scene_with("{packing: list, shape: {sphere: nan}, items: []}"),
     "scene.yaml:3:37: 'elements.0.shape.sphere': 'nan' is not a finite number"},
    {"yaml_nan", scene_with("{packing: list, shape: {sphere: .nan}, items: []}"), "scene.yaml:3:37: "},
    {"infinite_expression", scene_with("{packing: list, shape: {sphere: 1 / 0}, items: []}"),
     "scene.yaml:3:37: 'elements.0.shape.sphere': '1 / 0' is not a finite number"},
    {"overflow", scene_with("{packing: list, shape: {sphere: 1e999}, items: []}"), "scene.yaml:3:37: "},
    {"several_values", scene_with("{packing: list, shape: {sphere: \"1, 2\"}, items: []}"), "scene.yaml:3:37: "},
    {"unknown_parameter", scene_with("{packing: list, shape: {sphere: 2 * r}, items: []}"),
     "scene.yaml:3:37: 'elements.0.shape.sphere': cannot evaluate '2 * r'"},
    {"list_for_number", scene_with("{packing: list, shape: {sphere: [1]}, items: []}"),
     "scene.yaml:3:37: 'elements.0.shape.sphere' is a list"},
    {"zero_mass", scene_with("{packing: list, shape: {sphere: 1}, mass: 0, items: [{at: [0,0,0]}]}"),
     "scene.yaml:3:47: 'elements.0.mass' is 0, expected more than 0"},
    {"zero_density", scene_with(one, "", "0"), "scene.yaml:1:29: 'materials.rock.density' is 0, expected more than 0"},
    {"modulus_and_stiffness",
     "materials: {a: {density: 1, young: 1e9, normal_stiffness: 1e5}}\ntime: {dt: 1, steps: 1}",
     "scene.yaml:1:36: a material states both 'young' and 'normal_stiffness'"},
    {"poisson_without_young", "materials: {a: {density: 1, poisson: 0.3}}\ntime: {dt: 1, steps: 1}",
     "scene.yaml:1:38: 'poisson' is stated without 'young'"},
    {"restitution_above_one", "materials: {a: {density: 1, restitution: 1.5}}\ntime: {dt: 1, steps: 1}",
     "scene.yaml:1:42: 'materials.a.restitution' is 1.5, expected 0 to 1"},
    {"two_numbers", "gravity: [0, 1]\ntime: {dt: 1, steps: 1}",
     "scene.yaml:1:10: 'gravity' has 2 items, expected three numbers"},
    {"text_for_list", "gravity: down\ntime: {dt: 1, steps: 1}", "scene.yaml:1:10: 'gravity' is 'down', expected three"},
    {"not_true_or_false", "output: {pictures: maybe}\ntime: {dt: 1, steps: 1}",
     "scene.yaml:1:20: 'output.pictures' is 'maybe', expected true or false"},
    {"fraction_of_a_step", "time: {dt: 1, steps: 1.5}",
     "scene.yaml:1:22: 'time.steps' is 1.5, expected a whole number"},
    {"zero_dt", "time: {dt: 0, steps: 1}", "scene.yaml:1:12: 'time.dt' is 0, expected more than 0"},
    {"zero_substeps", "time: {dt: 1, steps: 1, substeps: 0}",
     "scene.yaml:1:35: 'time.substeps' is 0, expected a whole number of at least 1"},
    {"too_many_rounds", "time: {dt: 1, steps: 1e15, substeps: 1e4}",
     "scene.yaml:1:38: 1000000000000000 steps of 10000 substeps cannot be counted, expected at most 922337203685477 "},
    {"too_many_rounds_of_a_duration", "time: {dt: 1, duration: 1e15, substeps: 1e4}",
     "scene.yaml:1:41: 1000000000000000 steps of 10000 substeps cannot be counted"},
    {"too_many_threads", "time: {dt: 1, steps: 1}\nrun: {threads: 2e9}",
     "scene.yaml:2:16: 'run.threads' is 2000000000, expected a whole number of at most 4096"},
    {"too_wide_a_picture", "time: {dt: 1, steps: 1}\noutput: {picture_width: 4097}",
     "scene.yaml:2:25: 'output.picture_width' is 4097, expected a whole number of at most 4096"},
    {"inverted_box", scene_with("{packing: hcp, shape: {sphere: 1}, box: [[0, 0, 5], [9, 9, 1]]}"),
     "scene.yaml:3:45: 'elements.0.box' has no volume"},
    {"flat_hull", scene_with("{packing: list, shape: {hull: {points: [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]}}, items: []}"),
     "scene.yaml:3:28: the hull's points lie in one plane"},
    {"zero_axis",
     scene_with("{packing: list, shape: {sphere: 1}, items: [{at: [0,0,0], rotation: {axis: [0,0,0], angle: 1}}]}"),
     "scene.yaml:3:80: "},
};

const std::vector<Wrong> wrong_structure = {
    {"unknown_top_key", "tiem: {dt: 1}", "scene.yaml:1:1: unknown key 'tiem', expected one of name, parameters"},
    {"unknown_run_key", "time: {dt: 1, steps: 1}\nrun: {engin: ode}",
     "scene.yaml:2:7: unknown key 'engin', expected one of engine"},
    {"unknown_key_of_a_packing", scene_with("{packing: hcp, shape: {sphere: 1}, seeed: 4, cells: [1, 1, 1]}"),
     "scene.yaml:3:40: unknown key 'seeed'"},
    {"key_given_twice", "time: {dt: 1, dt: 2, steps: 1}", "scene.yaml:1:15: the key 'dt' is given twice"},
    {"bad_yaml", "time: {dt: 1", "scene.yaml:"},
    {"not_a_map", "- 1", "scene.yaml:1:1: not a scene"},
    {"empty_file", "", "scene.yaml:1:1: not a scene"},
    {"no_time", "name: x", "scene.yaml:1:1: the scene has no 'time', expected dt and steps or duration"},
    {"no_steps", "time: {dt: 1}", "scene.yaml:1:7: 'time' is incomplete, expected one of steps, duration"},
    {"steps_and_duration", "time: {dt: 1, steps: 1, duration: 2}", "scene.yaml:1:7: 'time' has both"},
    {"unknown_packing", scene_with("{packing: loose}"), "scene.yaml:3:15: unknown packing 'loose'"},
    {"no_packing", scene_with("{shape: {sphere: 1}}"), "scene.yaml:3:5: 'elements.0' has no 'packing'"},
    {"two_shapes", scene_with("{packing: list, shape: {sphere: 1, box: [1, 1, 1]}, items: []}"),
     "scene.yaml:3:28: 'elements.0.shape' has both 'sphere' and 'box'"},
    {"unknown_material", scene_with("{packing: list, material: rok, items: []}"),
     "scene.yaml:3:31: no material 'rok', expected one of rock; did you mean 'rock'?"},
    {"box_packed_hcp", scene_with("{packing: hcp, shape: {box: [1, 1, 1]}, cells: [1, 1, 1]}"),
     "scene.yaml:3:27: a lattice packs spheres only"},
    {"hcp_count_too_large", scene_with("{packing: hcp, shape: {sphere: 1}, count: 9, box: [[0,0,0],[2,2,2]]}"),
     "scene.yaml:3:47: only 1 spheres fit, expected room for 9"},
    {"random_too_full", scene_with("{packing: random, shape: {sphere: 1}, count: 9, box: [[0,0,0],[3,3,3]]}"),
     "scene.yaml:3:50: 9 elements do not fit without overlap"},
    {"weights",
     scene_with("{packing: random, shape: [{sphere: 1}], weights: [1, 2], count: 1, box: [[0,0,0],[3,3,3]]}"),
     "scene.yaml:3:54: 'elements.0.weights' has 2 items, expected 1 weights"},
    {"no_position", scene_with("{packing: list, shape: {sphere: 1}, items: [{id: 1}]}"),
     "scene.yaml:3:49: 'elements.0.items.0' has no 'at', expected a position"},
    {"duplicate_ids",
     scene_with("{packing: list, shape: {sphere: 1}, items: [{at: [0,0,0], id: 4},\n {at: [3,0,0], id: 4}]}"),
     "scene.yaml:4: the id 4 is given twice, first at "},
    {"id_out_of_range", scene_with("{packing: list, shape: {sphere: 1}, items: [{at: [0,0,0], id: -1}]}"),
     "scene.yaml:3:67: 'elements.0.items.0.id' is -1, expected a whole number of at least 0"},
    {"missing_table", scene_with("{packing: file, file: none.csv, shape: {sphere: 1}}"), "scene.yaml:3:27: "},
    {"missing_mesh", scene_with(one, "boundaries: [{mesh: {file: none.stl}}]"), "scene.yaml:5:28: "},
    {"unknown_output", "time: {dt: 1, steps: 1}\noutput: {formats: [pdf]}",
     "scene.yaml:2:20: unknown format 'pdf', expected pvd"},
    {"bad_parameter", "parameters: {a: b, b: 1}\ntime: {dt: 1, steps: 1}",
     "scene.yaml:1:17: parameter 'a': cannot evaluate"},
    {"parameter_named_as_a_constant", "parameters: {pi: 3}\ntime: {dt: 1, steps: 1}",
     "scene.yaml:1:18: parameter 'pi'"},
    {"parameter_with_a_bad_name", "parameters: {a-b: 3}\ntime: {dt: 1, steps: 1}", "scene.yaml:1:19: parameter 'a-b'"},
};

const std::vector<Wrong> wrong_ties = {
    {"bond_to_missing", scene_with(one, "bonds: [{a: 0, b: 9, stiffness: 1}]"),
     "scene.yaml:5:19: a bond to element 9, which does not exist"},
    {"bond_to_itself", scene_with(one, "bonds: [{a: 1, b: 1, stiffness: 1}]"),
     "scene.yaml:5:9: a bond of element 1 with itself"},
    {"bond_twice", scene_with(one, "bonds: [{a: 0, b: 1, stiffness: 1}, {a: 1, b: 0, stiffness: 1}]"),
     "scene.yaml:5:8: elements 0 and 1 are bonded twice"},
    {"bond_without_stiffness", scene_with(one, "bonds: {between: touching}"),
     "scene.yaml:5:8: 'bonds' has no 'stiffness'"},
    {"bond_between_others", scene_with(one, "bonds: {between: all, stiffness: 1}"),
     "scene.yaml:5:18: 'between' is 'all'"},
    {"bond_broken_at_rest", scene_with(one, "bonds: {between: touching, stiffness: 1, break_length: 0.9}"),
     "scene.yaml:5:56: a bond that breaks at rest"},
    {"motion_not_kinematic", scene_with(one, "boundaries: [{plane: {normal: [0,0,1]}, motion: {velocity: [1,0,0]}}]"),
     "scene.yaml:5:49: a boundary moves that is not kinematic"},
    {"kinematic_false",
     scene_with(one, "boundaries: [{plane: {normal: [0,0,1]}, kinematic: false, motion: {velocity: [1,0,0]}}]"),
     "scene.yaml:5:67: a boundary moves that is not kinematic"},
    {"kinematic_without_motion", scene_with(one, "boundaries: [{plane: {normal: [0,0,1]}, kinematic: true}]"),
     "scene.yaml:5:52: a kinematic boundary does not move"},
    {"ramps_too_long",
     scene_with(
         one,
         "boundaries: [{plane: {normal: [0,0,1]}, kinematic: true, motion: {velocity: [1,0,0], stop: 3, ramp: 2}}]"),
     "scene.yaml:5:101: two ramps of 2 s do not fit into 3 s"},
    {"zero_normal", scene_with(one, "boundaries: [{plane: {normal: [0,0,0]}}]"),
     "scene.yaml:5:31: 'boundaries.0.plane.normal' is the zero"},
    {"bad_triangle", scene_with(one, "boundaries: [{mesh: {vertices: [[0,0,0]], triangles: [[0,0,1]]}}]"),
     "scene.yaml:5:60: 'boundaries.0.mesh.triangles.0.2' is 1, expected a whole number of at most 0"},
};

std::string name_of(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Values, SceneError, testing::ValuesIn(wrong_values), name_of);
INSTANTIATE_TEST_SUITE_P(Structure, SceneError, testing::ValuesIn(wrong_structure), name_of);
INSTANTIATE_TEST_SUITE_P(Ties, SceneError, testing::ValuesIn(wrong_ties), name_of);

TEST(SceneErrors, MissingFile) {
  try {
    read_scene("/nowhere/scene.yaml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "/nowhere/scene.yaml: cannot read, expected a scene file");
  }
  EXPECT_THROW(read_scene(std::filesystem::temp_directory_path()), InputError);
}

TEST(SceneErrors, SeveralMaterialsMustBeNamed) {
  const std::string error = error_of(
      "materials: {a: {density: 1}, b: {density: 1}}\nboundaries: [{plane: {normal: [0,0,1]}}]\ntime: {dt: 1, steps: "
      "1}");
  EXPECT_EQ(error.substr(0, 39), "scene.yaml:2:14: no 'material' here, ex");
}

TEST(SceneErrors, AnOverrideNamesItsOrigin) {
  const std::string text = scene_with(one, "parameters: {size: 1}\n");
  const auto error = [&](const std::string& key, const std::string& value, const std::string& origin = "--set") {
    return error_of(text, {{key, value, origin}});
  };
  EXPECT_EQ(error("run.threads", "-1", "MORAINE_THREADS"),
            "MORAINE_THREADS run.threads: 'run.threads' is -1, expected a whole number of at least 0");
  EXPECT_EQ(error("run.restart", "", "--restart"), "--restart run.restart: 'run.restart' is empty, expected a text");
  EXPECT_EQ(error_of("time: {dt: 1, steps: 1e15}", {{"time.substeps", "1e9", "--substeps"}}).substr(0, 27),
            "--substeps time.substeps: 1");
  EXPECT_EQ(error("size", "nan").substr(0, 28), "--set size: parameter 'size'");
  EXPECT_EQ(error("run.engin", "ode").substr(0, 37), "--set run.engin: unknown key 'engin',");
  EXPECT_EQ(error("sice", "2").substr(0, 68), "--set sice=2: 'sice' is neither a parameter (size) nor a key of the ");
  EXPECT_NE(error("sice", "2").find("did you mean 'size'?"), std::string::npos);
  EXPECT_EQ(error("elements.3.mass", "2"),
            "--set elements.3.mass=2: a list of 1 has no item '3', expected a number below 1");
  EXPECT_EQ(error("time.dt.x", "2"), "--set time.dt.x=2: 'x' would be below a value, expected a map or a list there");
  EXPECT_EQ(error("gravity", "[0, 0").substr(0, 20), "--set gravity=[0, 0:");
  EXPECT_EQ(error("", "1").substr(0, 8), "--set =1");
  EXPECT_EQ(error("run.", "1").substr(0, 12), "--set run.=1");
  EXPECT_EQ(error("bonds.stiffness", "1").substr(0, 44), "--set bonds.stiffness: 'bonds' has no 'betwe");
}

}  // namespace
}  // namespace moraine
