// SPDX-License-Identifier: Apache-2.0
// ParaView data: an index of times per group (elements, ghosts, bonds) and a compressed piece per frame.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <sstream>

#include "output/file.hpp"
#include "output/frame_name.hpp"
#include "output/scene_table.hpp"
#include "output/vtu.hpp"
#include "output/writers.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

std::vector<Column> moment_columns(const Frame& frame) {
  return {{"TimeValue", 1, std::vector<double>{frame.time}},
          {"step", 1, std::vector<std::int64_t>{frame.step}},
          boundary_column(frame.boundary_poses)};
}

VtuGrid body_grid(const Scene& scene, const Frame& frame, const Frame::Bodies& bodies) {
  VtuGrid grid;
  grid.points = position_column(bodies);
  grid.point_data = body_columns(scene, bodies);
  grid.connectivity.resize(bodies.size());
  std::iota(grid.connectivity.begin(), grid.connectivity.end(), 0);
  grid.field_data = moment_columns(frame);
  return grid;
}

/// The ends of the bonds that hold, each element once, ascending by id.
std::vector<ElementId> bonded_ids(const Scene& scene, const Frame& frame) {
  std::vector<ElementId> ids;
  for (std::uint32_t b : frame.bonds) ids.insert(ids.end(), {scene.bonds[b].a, scene.bonds[b].b});
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

std::int64_t place_of(const std::vector<ElementId>& ascending, ElementId id) {
  return std::lower_bound(ascending.begin(), ascending.end(), id) - ascending.begin();
}

std::vector<double> points_of(const Frame::Bodies& elements, const std::vector<ElementId>& ids) {
  std::vector<double> points;
  for (ElementId id : ids) {
    const Vec3& p = elements.state.at(place_of(elements.id, id)).pose.position;
    points.insert(points.end(), {p.x(), p.y(), p.z()});
  }
  return points;
}

double strain(const Bond& bond, const std::vector<double>& points, std::int64_t a, std::int64_t b) {
  const double length = (Vec3(&points[3 * a]) - Vec3(&points[3 * b])).norm();
  return bond.rest_length > 0 ? length / bond.rest_length - 1 : 0;
}

VtuGrid bond_grid(const Scene& scene, const Frame& frame) {
  const std::vector<ElementId> ids = bonded_ids(scene, frame);
  const std::vector<double> points = points_of(frame.elements, ids);
  std::vector<double> strains;
  VtuGrid grid;
  grid.cell = VtuGrid::Cell::line;
  for (std::uint32_t bond : frame.bonds) {
    const std::int64_t a = place_of(ids, scene.bonds[bond].a), b = place_of(ids, scene.bonds[bond].b);
    grid.connectivity.insert(grid.connectivity.end(), {a, b});
    strains.push_back(strain(scene.bonds[bond], points, a, b));
  }
  grid.points.values = points;
  grid.point_data = {{"id", 1, ids}};
  grid.cell_data = {{"bond", 1, frame.bonds}, {"strain", 1, std::move(strains)}};
  grid.field_data = moment_columns(frame);
  return grid;
}

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw IoError(fmt::format("{}: cannot remove: {}", path.string(), error.message()));
}

/// One group's index, rewritten with every frame. After a restart it goes on with the frames written before. A run from
/// the start removes that of an earlier one: it may have had groups that this one lacks.
class Index {
 public:
  Index(const Scene& scene, const std::filesystem::path& folder, const char* group) : folder_(folder), group_(group) {
    if (goes_on(scene, path()))
      read();
    else
      remove_file(path());
  }
  void write(const Frame& frame, const VtuGrid& grid) {
    const std::string name = fmt::format("{}/{}", kFrames, frame_name(group_, frame.step, "vtu"));
    write_vtu(folder_ / name, grid);
    std::erase_if(rows_, [&](const Row& row) { return row.time >= frame.time; });
    rows_.push_back({frame.time, fmt::format("{}{}\" part=\"0\" file=\"{}\"/>\n", kRow, frame.time, name)});
    std::string rows;
    for (const Row& row : rows_) rows += row.text;
    replace_file(path(),
                 "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                 "byte_order=\"LittleEndian\">\n<Collection>\n" +
                     rows + "</Collection>\n</VTKFile>\n");
  }

 private:
  static constexpr const char* kRow = "<DataSet timestep=\"";
  struct Row {
    double time;
    std::string text;
  };

  std::filesystem::path path() const { return folder_ / fmt::format("{}.pvd", group_); }

  void read() {
    std::istringstream lines(read_file(path()));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(kRow)) rows_.push_back({std::stod(line.substr(std::strlen(kRow))), line + "\n"});
  }

  std::filesystem::path folder_;
  const char* group_;
  std::vector<Row> rows_;
};

class PvdWriter : public Writer {
 public:
  PvdWriter(const Scene& scene, const std::filesystem::path& folder)
      : scene_(scene),
        elements_(scene, folder, "elements"),
        ghosts_(scene, folder, "ghosts"),
        bonds_(scene, folder, "bonds") {
    make_folder(folder / kFrames);
    write_scene_table(scene, folder);
  }
  void write(const Frame& frame) override {
    elements_.write(frame, body_grid(scene_, frame, frame.elements));
    ghosts_.write(frame, body_grid(scene_, frame, frame.ghosts));
    if (!scene_.bonds.empty()) bonds_.write(frame, bond_grid(scene_, frame));
  }

 private:
  const Scene& scene_;
  Index elements_, ghosts_, bonds_;
};

}  // namespace

std::unique_ptr<Writer> make_pvd(const Scene& scene, const std::filesystem::path& folder) {
  return std::make_unique<PvdWriter>(scene, folder);
}

}  // namespace moraine
