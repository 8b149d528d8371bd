// SPDX-License-Identifier: Apache-2.0
// One file for all frames: VTKHDF 2.0, an unstructured grid with time. Each frame is one part; Steps says where its
// points, cells and arrays begin.
// Source: VTKHDF file format, section on temporal unstructured grids (docs.vtk.org).
#include <numeric>

#include "output/hdf5_file.hpp"
#include "output/writers.hpp"

namespace moraine {
namespace {

constexpr std::uint8_t kVertex = 1;

Column counting(std::size_t count) {
  std::vector<std::int64_t> values(count);
  std::iota(values.begin(), values.end(), 0);
  return {"", 1, std::move(values)};
}

class VtkHdfWriter : public Writer {
 public:
  VtkHdfWriter(const Scene& scene, const std::filesystem::path& folder)
      : scene_(scene), file_(folder / "elements.vtkhdf") {
    file_.group("/VTKHDF");
    file_.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{2, 0});
    file_.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
    for (const char* name : {"PointData", "CellData", "FieldData", "Steps", "Steps/PointDataOffsets"}) {
      file_.group(std::string("/VTKHDF/") + name);
    }
    file_.attribute("/VTKHDF/Steps", "NSteps", 0);
  }
  void write(const Frame& frame) override {
    const std::vector<Column> columns = body_columns(scene_, frame.elements);
    append_step(frame.time, columns);
    append_cells(frame.elements.size());
    file_.append("/VTKHDF/Points", position_column(frame.elements));
    for (const Column& column : columns) file_.append("/VTKHDF/PointData/" + column.name, column);
    points_ += static_cast<std::int64_t>(frame.elements.size());
    file_.attribute("/VTKHDF/Steps", "NSteps", ++steps_);
    file_.flush();
  }
  void finish() override { file_.close(); }

 private:
  void append_step(double time, const std::vector<Column>& columns) {
    const std::string steps = "/VTKHDF/Steps/";
    file_.append(steps + "Values", Column{"", 1, std::vector<double>{time}});
    file_.append(steps + "PartOffsets", steps_);
    file_.append(steps + "NumberOfParts", 1);
    for (const char* name : {"PointOffsets", "CellOffsets", "ConnectivityIdOffsets"}) {
      file_.append(steps + name, points_);
    }
    for (const Column& column : columns) file_.append(steps + "PointDataOffsets/" + column.name, points_);
  }
  void append_cells(std::size_t count) {
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
      file_.append(std::string("/VTKHDF/") + name, static_cast<std::int64_t>(count));
    }
    file_.append("/VTKHDF/Connectivity", counting(count));
    file_.append("/VTKHDF/Offsets", counting(count + 1));
    file_.append("/VTKHDF/Types", Column{"", 1, std::vector<std::uint8_t>(count, kVertex)});
  }

  const Scene& scene_;
  Hdf5File file_;
  std::int64_t steps_ = 0, points_ = 0;
};

}  // namespace

std::unique_ptr<Writer> make_vtkhdf(const Scene& scene, const std::filesystem::path& folder) {
  return std::make_unique<VtkHdfWriter>(scene, folder);
}

}  // namespace moraine
