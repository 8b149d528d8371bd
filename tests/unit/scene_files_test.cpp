// SPDX-License-Identifier: Apache-2.0
// Tables and meshes beside a scene.
#include <gtest/gtest.h>

#include <numbers>

#include "physics/scene/mesh_file.hpp"
#include "physics/scene/table_file.hpp"
#include "scene_text.hpp"

namespace moraine {
namespace {

const std::string tetrahedron = R"(solid t
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 1 0
vertex 1 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 0 1
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 1
vertex 0 1 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 1 0 0
vertex 0 1 0
vertex 0 0 1
endloop
endfacet
endsolid t
)";

const std::string lammps = R"(grains, as LAMMPS writes them

3 atoms
1 atom types
0 10 xlo xhi
0 10 ylo yhi
0 10 zlo zhi

Masses

1 5.0

Atoms # sphere

2 1 2.0 100 1 2 3 0 0 0
1 1 1.0 200 4 5 6 0 0 0
3 1 1.0 200 8 8 8

Velocities

1 0.1 0.2 0.3 0 0 1
)";

const std::string head = "materials: {m: {density: 1000}}\ntime: {dt: 1, steps: 1}\n";

template <class Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const InputError& e) {
    return std::filesystem::path(e.what()).filename();
  }
  return "";
}

TEST(MeshFile, StlCornersAreMerged) {
  const Folder folder;
  const TriangleMesh mesh = read_mesh(folder.write("t.stl", tetrahedron));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
}

TEST(MeshFile, ObjFacesBecomeTriangles) {
  const Folder folder;
  const TriangleMesh mesh = read_mesh(folder.write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(MeshFile, ScenesReadHullsAndBoundariesFromFiles) {
  const Folder folder;
  folder.write("t.stl", tetrahedron);
  const Scene scene = read_scene(folder.write("scene.yaml", head + R"(
elements: [{packing: list, shape: {hull: {file: t.stl}}, items: [{at: [1, 1, 1]}]}]
boundaries: [{mesh: {file: t.stl}, at: [0, 0, -5]}]
)"));
  EXPECT_NEAR(scene.elements[0].mass, 1000.0 / 6, 1e-9);
  EXPECT_LE((scene.elements[0].state.pose.position - Vec3::Constant(1.25)).norm(), 1e-12);
  EXPECT_EQ(std::get<TriangleMesh>(scene.boundaries[0].geometry).triangles.size(), 4u);
}

TEST(MeshFile, BrokenFilesAreRefused) {
  const Folder folder;
  EXPECT_THROW(read_mesh(folder.write("t.stl", "nonsense")), InputError);
  EXPECT_THROW(read_mesh(folder.write("t.obj", "v 0 0 0\n")), InputError);
  EXPECT_THROW(read_mesh("/nowhere.stl"), InputError);
}

TEST(Csv, ReadsColumnsInAnyOrder) {
  const Folder folder;
  folder.write("grains.csv", "# grains\nz, x, y, radius, id, vx\n3, 1, 2, 0.5, 9, 4\n\n6, 4, 5, 0.25, 8, 0\n");
  const Scene scene = read_scene(folder.write("scene.yaml", head + "elements: [{packing: file, file: grains.csv}]"));
  ASSERT_EQ(scene.elements.size(), 2u);
  EXPECT_EQ(scene.elements[1].id, 9u);
  EXPECT_EQ(scene.elements[1].state.pose.position, Vec3(1, 2, 3));
  EXPECT_EQ(scene.elements[1].state.twist.linear, Vec3(4, 0, 0));
  EXPECT_NEAR(scene.elements[1].mass, 1000 * std::numbers::pi / 6, 1e-9);
  EXPECT_EQ(scene.shape_of(scene.elements[0]).bounding_radius, 0.25);
}

TEST(Csv, TakesTheShapeOfTheEntryIfItHasNoRadii) {
  const Folder folder;
  folder.write("grains.csv", "x,y,z\n1,2,3\n");
  const std::string entry = "elements: [{packing: file, file: grains.csv, velocity: [1, 0, 0]";
  const Scene scene = read_scene(folder.write("scene.yaml", head + entry + ", shape: {sphere: 2}}]"));
  EXPECT_EQ(scene.elements[0].state.twist.linear.x(), 1);
  EXPECT_THROW(read_scene(folder.write("scene.yaml", head + entry + "}]")), InputError);
}

TEST(Csv, ErrorsNameTheLine) {
  const Folder folder;
  const auto error = [&](const std::string& text) {
    return message_of([&] { read_csv(folder.write("a.csv", text)); });
  };
  EXPECT_EQ(error(""), "a.csv:1: the file is empty, expected a header line such as id,x,y,z,radius");
  EXPECT_EQ(error("x,y\n"), "a.csv:1: no column 'z', expected at least x, y, z");
  EXPECT_EQ(error("x,y,z,w\n").substr(0, 27), "a.csv:1: unknown column 'w'");
  EXPECT_EQ(error("x,y,z,\n").substr(0, 26), "a.csv:1: unknown column ''");
  EXPECT_EQ(error("x,y,z,x\n"), "a.csv:1: column 'x' appears twice");
  EXPECT_EQ(error("x,y,z\n1,2\n"), "a.csv:2: 2 values, expected 3 as in the header");
  EXPECT_EQ(error("x,y,z\n1,2,a\n"), "a.csv:2: z is 'a', expected a finite number");
  EXPECT_EQ(error("x,y,z\n1,2,nan\n"), "a.csv:2: z is 'nan', expected a finite number");
  EXPECT_EQ(error("x,y,z,radius\n1,2,3,0\n"), "a.csv:2: radius is 0, expected more than 0");
  EXPECT_EQ(error("x,y,z,id\n1,2,3,-1\n").substr(0, 22), "a.csv:2: the id is '-1");
}

TEST(Csv, DuplicateIdsNameBothLines) {
  const Folder folder;
  folder.write("grains.csv", "id,x,y,z\n5,1,2,3\n5,3,3,3\n");
  const std::string text = head + "elements: [{packing: file, file: grains.csv, shape: {sphere: 1}}]";
  try {
    read_scene(folder.write("scene.yaml", text));
    FAIL();
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("grains.csv:3: the id 5 is given twice, first at "), std::string::npos) << what;
    EXPECT_NE(what.find("grains.csv:2;"), std::string::npos) << what;
  }
}

TEST(Lammps, ReadsAtomsAndVelocities) {
  const Folder folder;
  folder.write("grains.data", lammps);
  const Scene scene = read_scene(folder.write("scene.yaml", head + "elements: [{packing: file, file: grains.data}]"));
  ASSERT_EQ(scene.elements.size(), 3u);
  const Element &first = scene.elements[0], &second = scene.elements[1];
  EXPECT_EQ(first.state.pose.position, Vec3(4, 5, 6));
  EXPECT_EQ(first.state.twist.linear, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(first.state.twist.angular, Vec3(0, 0, 1));
  EXPECT_NEAR(first.mass, 200 * std::numbers::pi / 6, 1e-9);
  EXPECT_EQ(scene.shape_of(second).bounding_radius, 1);
  EXPECT_TRUE(second.state.twist.linear.isZero());
}

TEST(Lammps, ErrorsNameTheLine) {
  const Folder folder;
  const auto error = [&](const std::string& text) {
    return message_of([&] { read_lammps(folder.write("a.data", text)); });
  };
  EXPECT_EQ(error("t\n2 atoms\nAtoms # sphere\n\n1 1 1 1 0 0 0\n"),
            "a.data:5: the file ends after 1 atoms, expected 2 as its header says");
  EXPECT_EQ(error("t\n1 atoms\nAtoms # full\n\n"), "a.data:3: atom style 'full', expected sphere");
  EXPECT_EQ(error("t\n1 atoms\nAtoms\n\n1 1 1 1 0 0\n"), "a.data:5: 6 values, expected id type diameter density x y z");
  EXPECT_EQ(error("t\n1 atoms\nAtoms\n\n1 1 0 1 0 0 0\n"), "a.data:5: the diameter is 0, expected more than 0");
  EXPECT_EQ(error("t\n0 atoms\nBonds\n"), "a.data:3: unknown section 'Bonds', expected Atoms or Velocities");
  EXPECT_EQ(error("t\n1 atoms\nAtoms\n\n1 1 1 1 0 0 0\nVelocities\n\n2 0 0 0 0 0 0\n"),
            "a.data:8: velocity of atom 2, expected an atom of this file");
}

}  // namespace
}  // namespace moraine
