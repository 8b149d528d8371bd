// SPDX-License-Identifier: Apache-2.0
// The reader of VTK 9.1 knows VTKHDF 1 only: it takes frames for parts. So HDF5 itself checks the file against the
// format's description, and VTK reads the parts.
#include <gtest/gtest.h>

#include "output/hdf5_file.hpp"
#include "output/writer.hpp"
#include "output_sample.hpp"
#include "output_vtk.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

class VtkHdf : public testing::Test {
 protected:
  void SetUp() override {
    const auto writer = find_writer("vtkhdf").make(scene_, folder_.path());
    writer->write(sample::frame(scene_, 0));
    for (int i = 0; i < 3; ++i) {
      shorter_.elements.id.pop_back();
      shorter_.elements.sub_model.pop_back();
      shorter_.elements.shape.pop_back();
      shorter_.elements.state.pop_back();
    }
    writer->write(shorter_);
    writer->write(sample::frame(scene_, 120));
    writer->finish();
  }
  template <class T>
  std::vector<T> table(const std::string& name, hid_t type, std::vector<hsize_t>* shape = nullptr) {
    const Hdf5Handle file(H5Fopen((folder_ / "elements.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle set(H5Dopen2(file, ("/VTKHDF/" + name).c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(set), H5Sclose);
    if (shape) {
      shape->resize(H5Sget_simple_extent_ndims(space));
      H5Sget_simple_extent_dims(space, shape->data(), nullptr);
    }
    std::vector<T> values(H5Sget_simple_extent_npoints(space));
    EXPECT_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    return values;
  }
  std::vector<std::int64_t> integers(const std::string& name) { return table<std::int64_t>(name, H5T_NATIVE_INT64); }

  using Integers = std::vector<std::int64_t>;
  const sample::Folder folder_{"vtkhdf"};
  const Scene scene_ = sample::scene();
  Frame shorter_ = sample::frame(scene_, 60);
};

TEST_F(VtkHdf, StepsSayWhereEachFrameBegins) {
  EXPECT_EQ(table<double>("Steps/Values", H5T_NATIVE_DOUBLE), (std::vector<double>{0, 30, 60}));
  EXPECT_EQ(integers("Steps/PartOffsets"), (Integers{0, 1, 2}));
  EXPECT_EQ(integers("Steps/NumberOfParts"), (Integers{1, 1, 1}));
  for (const char* name : {"PointOffsets", "CellOffsets", "ConnectivityIdOffsets", "PointDataOffsets/velocity"}) {
    EXPECT_EQ(integers(std::string("Steps/") + name), (Integers{0, 10, 17})) << name;
  }
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
    EXPECT_EQ(integers(name), (Integers{10, 7, 10})) << name;
  }
}

TEST_F(VtkHdf, CellsAreOnePointEach) {
  EXPECT_EQ(integers("Types"), Integers(27, 1));
  const Integers offsets = integers("Offsets"), points = integers("Connectivity");
  ASSERT_EQ(offsets.size(), 27u + 3u) << "one more than cells in every part";
  EXPECT_EQ(Integers(offsets.begin() + 11, offsets.begin() + 19), (Integers{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(Integers(points.begin() + 10, points.begin() + 17), (Integers{0, 1, 2, 3, 4, 5, 6}));
}

TEST_F(VtkHdf, ArraysFollowEachOther) {
  std::vector<hsize_t> shape;
  const auto points = table<double>("Points", H5T_NATIVE_DOUBLE, &shape);
  EXPECT_EQ(shape, (std::vector<hsize_t>{27, 3}));
  const auto turns = table<double>("PointData/orientation", H5T_NATIVE_DOUBLE, &shape);
  EXPECT_EQ(shape, (std::vector<hsize_t>{27, 4}));
  const auto ids = table<std::uint32_t>("PointData/id", H5T_NATIVE_UINT32);
  const Frame last = sample::frame(scene_, 120);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(Vec3(&points[3 * (17 + i)]), last.elements.state[i].pose.position);
    EXPECT_EQ(turns[4 * (17 + i)], last.elements.state[i].pose.orientation.w());
    EXPECT_EQ(ids[17 + i], last.elements.id[i]);
  }
}

TEST_F(VtkHdf, NamesTypeVersionAndSteps) {
  const Hdf5Handle file(H5Fopen((folder_ / "elements.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  std::int64_t version[2] = {}, steps = 0;
  char text[32] = {};
  const Hdf5Handle v(H5Aopen_by_name(file, "/VTKHDF", "Version", H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle t(H5Aopen_by_name(file, "/VTKHDF", "Type", H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle n(H5Aopen_by_name(file, "/VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(t), H5Tclose);
  ASSERT_LE(H5Tget_size(type), sizeof(text));
  EXPECT_GE(H5Aread(v, H5T_NATIVE_INT64, version), 0);
  EXPECT_GE(H5Aread(t, type, text), 0);
  EXPECT_GE(H5Aread(n, H5T_NATIVE_INT64, &steps), 0);
  EXPECT_EQ(version[0], 2);
  EXPECT_EQ(version[1], 0);
  EXPECT_EQ(std::string(text), "UnstructuredGrid");
  EXPECT_EQ(steps, 3);
}

TEST_F(VtkHdf, VtkReadsTheFramesAsParts) {
  const sample::Json seen = sample::seen_by_vtk(folder_.path())["vtkhdf"];
  ASSERT_EQ(seen["points"].size(), 27u);
  ASSERT_EQ(seen["cells"].size(), 27u);
  const Frame last = sample::frame(scene_, 120);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(seen["cells"][17 + i], sample::Json::array({17 + i}));
    EXPECT_EQ(seen["points"][17 + i][0], last.elements.state[i].pose.position.x());
    EXPECT_EQ(seen["point_data"]["id"][17 + i], last.elements.id[i]);
    EXPECT_EQ(seen["point_data"]["velocity"][17 + i][2], last.elements.state[i].twist.linear.z());
  }
}

/// Frames from 60 on are written again, as after a restart from step 50; the file is then as if nothing had happened.
TEST_F(VtkHdf, GoesOnAfterARestart) {
  const auto tables = [&] {
    std::vector<std::vector<double>> all;
    for (const char* name : {"Steps/Values", "Steps/PartOffsets", "Steps/NumberOfParts", "Steps/PointOffsets",
                             "Steps/CellOffsets", "Steps/ConnectivityIdOffsets", "Steps/PointDataOffsets/velocity",
                             "NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Points", "Connectivity",
                             "Offsets", "Types", "PointData/id", "PointData/orientation"})
      all.push_back(table<double>(name, H5T_NATIVE_DOUBLE));
    return all;
  };
  const auto before = tables();
  Scene scene = scene_;
  scene.run.restart = "latest";
  for (const Frame& frame : {shorter_, sample::frame(scene, 120)}) {
    const auto writer = find_writer("vtkhdf").make(scene, folder_.path());
    writer->write(frame);
    writer->finish();
    if (frame.step == 60) {
      EXPECT_EQ(table<double>("Steps/Values", H5T_NATIVE_DOUBLE), (std::vector<double>{0, 30}));
    }
  }
  EXPECT_EQ(tables(), before);
}

TEST_F(VtkHdf, IsRefusedIfItCannotGoOn) {
  Scene scene = scene_;
  scene.run.restart = "latest";
  std::filesystem::resize_file(folder_ / "elements.vtkhdf", 1000);
  try {
    find_writer("vtkhdf").make(scene, folder_.path());
    FAIL() << "expected IoError";
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("move it away"), std::string::npos) << e.what();
  }
}

TEST(VtkHdfErrors, NameTheFile) {
  try {
    find_writer("vtkhdf").make(sample::scene(), "/nowhere");
    FAIL() << "expected IoError";
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("/nowhere/elements.vtkhdf"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace moraine
