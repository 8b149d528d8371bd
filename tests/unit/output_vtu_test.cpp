// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "output/file.hpp"
#include "output/read_frames.hpp"
#include "output/vtu.hpp"
#include "output/writer.hpp"
#include "output/zlib_blocks.hpp"
#include "output_sample.hpp"
#include "output_vtk.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

using sample::Json;
using sample::seen_by_vtk;

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void expect_bodies(const Json& seen, const Scene& scene, const Frame::Bodies& bodies) {
  ASSERT_EQ(seen["points"].size(), bodies.size());
  ASSERT_EQ(seen["cells"].size(), bodies.size());
  const Json& data = seen["point_data"];
  for (const char* name :
       {"id", "sub_model", "shape", "shape_kind", "radius", "orientation", "velocity", "angular_velocity"}) {
    ASSERT_TRUE(data.contains(name)) << name;
    ASSERT_EQ(data[name].size(), bodies.size()) << name;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto& [pose, twist] = bodies.state[i];
    const Quat& q = pose.orientation;
    EXPECT_EQ(seen["points"][i], json_of(pose.position));
    EXPECT_EQ(seen["cells"][i], Json::array({i}));
    EXPECT_EQ(data["id"][i], bodies.id[i]);
    EXPECT_EQ(data["sub_model"][i], bodies.sub_model[i]);
    EXPECT_EQ(data["shape"][i], bodies.shape[i]);
    EXPECT_EQ(data["shape_kind"][i], scene.shapes[bodies.shape[i]].geometry.index());
    EXPECT_EQ(data["radius"][i], scene.shapes[bodies.shape[i]].bounding_radius);
    EXPECT_EQ(data["orientation"][i], Json({q.w(), q.x(), q.y(), q.z()}));
    EXPECT_EQ(data["velocity"][i], json_of(twist.linear));
    EXPECT_EQ(data["angular_velocity"][i], json_of(twist.angular));
  }
}

TEST(Pvd, VtkReadsEveryGroupAndFrame) {
  const sample::Folder folder("pvd");
  const Scene scene = sample::scene();
  const Frame first = sample::frame(scene, 0), last = sample::frame(scene, 120);
  const auto writer = find_writer("pvd").make(scene, folder.path());
  writer->write(first);
  writer->write(last);
  writer->finish();
  const Json seen = seen_by_vtk(folder.path());
  ASSERT_EQ(seen["elements"].size(), 2u);
  ASSERT_EQ(seen["ghosts"].size(), 2u);
  EXPECT_EQ(seen["elements"][1]["time"], last.time);
  EXPECT_EQ(seen["elements"][1]["field_data"]["step"][0], last.step);
  expect_bodies(seen["elements"][0], scene, first.elements);
  expect_bodies(seen["elements"][1], scene, last.elements);
  expect_bodies(seen["ghosts"][1], scene, last.ghosts);
}

TEST(Pvd, VtkReadsBondsAsLines) {
  const sample::Folder folder("pvd_bonds");
  const Scene scene = sample::scene();
  const Frame frame = sample::frame(scene);
  find_writer("pvd").make(scene, folder.path())->write(frame);
  const Json bonds = seen_by_vtk(folder.path())["bonds"].at(0);
  ASSERT_EQ(bonds["cells"].size(), frame.bonds.size());
  EXPECT_EQ(bonds["points"].size(), frame.bonds.size() + 1) << "elements whose bonds are broken are left out";
  EXPECT_EQ(bonds["cell_types"], Json({3}));
  for (std::size_t i = 0; i < frame.bonds.size(); ++i) {
    const Vec3 a = frame.elements.state[frame.bonds[i]].pose.position;
    const Vec3 b = frame.elements.state[frame.bonds[i] + 1].pose.position;
    EXPECT_EQ(bonds["points"][bonds["cells"][i][0].get<int>()], json_of(a));
    EXPECT_EQ(bonds["points"][bonds["cells"][i][1].get<int>()], json_of(b));
    EXPECT_EQ(bonds["cell_data"]["bond"][i], frame.bonds[i]);
    EXPECT_NEAR(bonds["cell_data"]["strain"][i].get<double>(), (a - b).norm() - 1, 1e-12);
  }
}

TEST(Pvd, VtkReadsFramesWithoutGhostsOrBonds) {
  const sample::Folder folder("pvd_empty");
  Scene scene = sample::scene();
  scene.bonds.clear();
  Frame frame = sample::frame(scene);
  frame.ghosts = {};
  find_writer("pvd").make(scene, folder.path())->write(frame);
  const Json seen = seen_by_vtk(folder.path());
  EXPECT_TRUE(seen["ghosts"].at(0)["points"].empty());
  EXPECT_TRUE(seen["bonds"].empty());
}

TEST(Pvd, VtkReadsArraysOfManyBlocks) {
  const sample::Folder folder("pvd_many");
  const Scene scene = sample::scene(20000);
  const Frame frame = sample::frame(scene);
  find_writer("pvd").make(scene, folder.path())->write(frame);
  const Json elements = seen_by_vtk(folder.path())["elements"].at(0);
  ASSERT_EQ(elements["points"].size(), 20000u);
  EXPECT_EQ(elements["points"][19999], json_of(frame.elements.state[19999].pose.position));
  EXPECT_EQ(elements["point_data"]["id"][19999], frame.elements.id[19999]);
}

/// What a kill between the indices leaves, and what one sees who reads just then.
TEST(Pvd, IsReadAsFarAsAllGroupsHaveFrames) {
  for (const char* behind : {"ghosts.pvd", "bonds.pvd"}) {
    const sample::Folder folder("pvd_behind");
    const Scene scene = sample::scene();
    const auto writer = find_writer("pvd").make(scene, folder.path());
    for (std::int64_t step : {0, 60}) writer->write(sample::frame(scene, step));
    const std::string before = read_file(folder / behind);
    writer->write(sample::frame(scene, 120));
    replace_file(folder / behind, before);
    const RecordedRun run(folder.path());
    EXPECT_EQ(run.times(), (std::vector<double>{0, 30})) << behind;
    EXPECT_EQ(run.frame(1).step, 60) << behind;
  }
}

TEST(Pvd, ForgetsTheGroupsOfAnEarlierRun) {
  const sample::Folder folder("pvd_earlier");
  Scene scene = sample::scene();
  find_writer("pvd").make(scene, folder.path())->write(sample::frame(scene, 0));
  scene.bonds.clear();
  const auto writer = find_writer("pvd").make(scene, folder.path());
  for (std::int64_t step : {0, 60}) writer->write(sample::frame(scene, step));
  EXPECT_FALSE(std::filesystem::exists(folder / "bonds.pvd"));
  const RecordedRun run(folder.path());
  EXPECT_EQ(run.times(), (std::vector<double>{0, 30}));
  EXPECT_TRUE(run.frame(1).bonds.empty());
}

TEST(Pvd, NamesThePathItCannotWrite) {
  const sample::Folder folder("pvd_full");
  const Scene scene = sample::scene();
  const auto writer = find_writer("pvd").make(scene, folder.path());
  std::filesystem::remove_all(folder.path());
  try {
    writer->write(sample::frame(scene));
    FAIL() << "expected IoError";
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("frames/elements_000120.vtu"), std::string::npos) << e.what();
  }
}

TEST(OutputFile, ReportsAFullDisk) {
  EXPECT_THROW(
      {
        OutputFile file("/dev/full");
        file.write("something");
        file.close();
      },
      IoError);
}

TEST(Vtu, DamageIsAnError) {
  const sample::Folder folder("vtu_damage");
  VtuGrid grid;
  grid.points.values = std::vector<double>(300, 0.125);
  write_vtu(folder / "whole.vtu", grid);
  const std::string whole = read_file(folder / "whole.vtu");
  EXPECT_EQ(read_vtu(folder / "whole.vtu").points.tuples(), 100u);
  for (std::size_t keep = 0; keep + 40 < whole.size(); keep += 17) {
    replace_file(folder / "cut.vtu", whole.substr(0, keep));
    EXPECT_THROW(read_vtu(folder / "cut.vtu"), IoError) << keep;
  }
}

TEST(ZlibBlocks, RoundTripAtBlockBoundaries) {
  for (std::size_t size : {0u, 1u, (1u << 18) - 1, 1u << 18, (1u << 18) + 1, 3u << 18}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * i >> 3);
    EXPECT_EQ(unpack_blocks("xx" + pack_blocks(bytes), 2), bytes) << size;
  }
}

TEST(Writers, UnknownFormatListsTheTable) {
  try {
    find_writer("vtk");
    FAIL() << "expected InputError";
  } catch (const InputError& e) {
    for (const WriterRow& row : writers()) EXPECT_NE(std::string(e.what()).find(row.name), std::string::npos);
  }
}

}  // namespace
}  // namespace moraine
