// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <sstream>

#include "output/file.hpp"
#include "output/writer.hpp"
#include "output_sample.hpp"

namespace moraine {
namespace {

std::vector<double> numbers(std::string line) {
  for (char& c : line) c = c == ',' ? ' ' : c;
  std::istringstream in(line);
  std::vector<double> values;
  for (std::string word; in >> word;) values.push_back(std::strtod(word.c_str(), nullptr));
  return values;
}

std::vector<std::string> lines(const std::filesystem::path& path) {
  std::istringstream in(read_file(path));
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

TEST(Csv, ReadsBackToTheSameNumbers) {
  const sample::Folder folder("csv");
  const Scene scene = sample::scene();
  const Frame frame = sample::frame(scene);
  const auto writer = find_writer("csv").make(scene, folder.path());
  writer->write(frame);
  writer->finish();
  const auto rows = lines(folder / "frames/elements_000120.csv");
  ASSERT_EQ(rows.size(), frame.elements.size() + 1);
  EXPECT_EQ(rows[0], "id,sub_model,shape,radius,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz");
  for (std::size_t i = 0; i < frame.elements.size(); ++i) {
    const std::vector<double> v = numbers(rows[i + 1]);
    ASSERT_EQ(v.size(), 17u);
    EXPECT_EQ(v[0], frame.elements.id[i]);
    EXPECT_EQ(v[1], frame.elements.sub_model[i]);
    EXPECT_EQ(v[3], scene.shapes[v[2]].bounding_radius);
    const ElementState read{{Vec3(&v[4]), Quat(v[7], v[8], v[9], v[10])}, {Vec3(&v[11]), Vec3(&v[14])}};
    EXPECT_TRUE(sample::same(read, frame.elements.state[i])) << rows[i + 1];
  }
}

TEST(LammpsDump, HoldsEveryFrameInTheDocumentedColumns) {
  const sample::Folder folder("dump");
  const Scene scene = sample::scene();
  const Frame first = sample::frame(scene, 0), last = sample::frame(scene, 120);
  const auto writer = find_writer("lammps_dump").make(scene, folder.path());
  writer->write(first);
  writer->write(last);
  writer->finish();
  const auto rows = lines(folder / "dump.lammpstrj");
  const std::size_t per_frame = 9 + first.elements.size(), at = per_frame;
  ASSERT_EQ(rows.size(), 2 * per_frame);
  EXPECT_EQ(rows[at], "ITEM: TIMESTEP");
  EXPECT_EQ(rows[at + 1], "120");
  EXPECT_EQ(rows[at + 3], "10");
  EXPECT_EQ(rows[at + 4], "ITEM: BOX BOUNDS ss ss ss");
  EXPECT_EQ(rows[at + 8], "ITEM: ATOMS id type radius x y z vx vy vz quatw quati quatj quatk");
  for (std::size_t i = 0; i < last.elements.size(); ++i) {
    const std::vector<double> v = numbers(rows[at + 9 + i]);
    const auto& [pose, twist] = last.elements.state[i];
    ASSERT_EQ(v.size(), 13u);
    EXPECT_EQ(v[0], last.elements.id[i]);
    EXPECT_EQ(v[1], last.elements.sub_model[i] + 1);
    EXPECT_EQ(Vec3(&v[3]), pose.position);
    EXPECT_EQ(Vec3(&v[6]), twist.linear);
    EXPECT_EQ(Quat(v[9], v[10], v[11], v[12]).coeffs(), pose.orientation.coeffs());
  }
}

/// What is written after a stop in the middle of a frame, from step 120 on again.
TEST(LammpsDump, GoesOnAfterARestart) {
  const sample::Folder folder("dump_restart"), whole_folder("dump_whole");
  Scene scene = sample::scene();
  const auto write = [&](const sample::Folder& to, std::vector<std::int64_t> steps) {
    const auto writer = find_writer("lammps_dump").make(scene, to.path());
    for (const std::int64_t step : steps) writer->write(sample::frame(scene, step));
    writer->finish();
  };
  write(whole_folder, {0, 60, 120, 180});
  write(folder, {0, 60, 120, 150});
  const auto file = folder / "dump.lammpstrj";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 7);
  scene.run.restart = "latest";
  write(folder, {120, 180});
  EXPECT_EQ(read_file(file), read_file(whole_folder / "dump.lammpstrj"));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 7);
  write(folder, {});
  write(folder, {240});
  EXPECT_EQ(lines(file)[3 * (9 + scene.elements.size()) + 1], "240") << "what is not whole is dropped";
}

}  // namespace
}  // namespace moraine
