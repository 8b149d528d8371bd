// SPDX-License-Identifier: Apache-2.0
// One file for all frames: VTKHDF 2.0, an unstructured grid with time. Each frame is one part; Steps says where its
// points, cells and arrays begin. After a restart the file goes on where the run does.
// Source: VTKHDF file format, section on temporal unstructured grids (docs.vtk.org).
#include <algorithm>
#include <numeric>
#include <utility>

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
      : scene_(scene), has_more_(goes_on(scene, folder / kFile)), file_(folder / kFile, has_more_) {
    if (!has_more_) begin();
  }
  void write(const Frame& frame) override {
    const std::vector<Column> columns = body_columns(scene_, frame.elements);
    if (std::exchange(has_more_, false)) cut_back(frame.time, columns);
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
  static constexpr const char* kFile = "elements.vtkhdf";

  void begin() {
    file_.group("/VTKHDF");
    file_.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{2, 0});
    file_.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
    for (const char* name : {"PointData", "CellData", "FieldData", "Steps", "Steps/PointDataOffsets"}) {
      file_.group(std::string("/VTKHDF/") + name);
    }
    file_.attribute("/VTKHDF/Steps", "NSteps", 0);
  }
  /// Keeps the whole frames before `time`.
  void cut_back(double time, const std::vector<Column>& columns) {
    const std::vector<double> times = file_.numbers("/VTKHDF/Steps/Values");
    const std::vector<double> counts = file_.numbers("/VTKHDF/NumberOfPoints");
    steps_ = std::lower_bound(times.begin(), times.end(), time) - times.begin();
    steps_ = std::min(steps_, file_.number("/VTKHDF/Steps", "NSteps"));
    for (std::int64_t i = 0; i < steps_; ++i) points_ += static_cast<std::int64_t>(counts.at(i));
    const auto keep = [&](const std::string& name, std::int64_t rows) { file_.keep("/VTKHDF/" + name, rows); };
    for (const char* name :
         {"Steps/Values", "Steps/PartOffsets", "Steps/NumberOfParts", "Steps/PointOffsets", "Steps/CellOffsets",
          "Steps/ConnectivityIdOffsets", "NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
      keep(name, steps_);
    for (const char* name : {"Points", "Connectivity", "Types"}) keep(name, points_);
    keep("Offsets", points_ + steps_);
    for (const Column& column : columns) {
      keep("Steps/PointDataOffsets/" + column.name, steps_);
      keep("PointData/" + column.name, points_);
    }
  }
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
  bool has_more_;  ///< frames from before a restart, not yet cut back to where it goes on
  Hdf5File file_;
  std::int64_t steps_ = 0, points_ = 0;
};

}  // namespace

std::unique_ptr<Writer> make_vtkhdf(const Scene& scene, const std::filesystem::path& folder) {
  return std::make_unique<VtkHdfWriter>(scene, folder);
}

}  // namespace moraine
