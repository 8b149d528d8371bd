// SPDX-License-Identifier: Apache-2.0
#include "output/read_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>

#include "output/file.hpp"
#include "output/scene_table.hpp"
#include "output/vtu.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

using FilesByTime = std::map<double, std::string>;

FilesByTime read_index(const std::filesystem::path& path) {
  static const std::regex entry("<DataSet timestep=\"([^\"]*)\" part=\"0\" file=\"([^\"]*)\"/>");
  const std::string text = read_file(path);
  FilesByTime files;
  for (std::sregex_iterator at(text.begin(), text.end(), entry), end; at != end; ++at) {
    files[std::strtod((*at)[1].str().c_str(), nullptr)] = (*at)[2].str();
  }
  return files;
}

/// Runs `read` and says which file was at fault.
template <class Read>
auto naming(const std::filesystem::path& path, Read&& read) {
  try {
    return read();
  } catch (const IoError& e) {
    throw IoError(fmt::format("{}: {}", path.string(), e.what()));
  }
}

Frame::Bodies bodies_of(const VtuGrid& grid, const Scene& scene) {
  Frame::Bodies bodies = bodies_from_columns(grid.points, grid.point_data);
  for (std::uint32_t shape : bodies.shape) {
    if (shape >= scene.shapes.size()) throw IoError(fmt::format("shape {} is not in the table of shapes", shape));
  }
  return bodies;
}

const Column& field(const VtuGrid& grid, std::string_view name) {
  const auto& fields = grid.field_data;
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Column& c) { return c.name == name; });
  if (found == fields.end()) throw IoError(fmt::format("field '{}' is missing", name));
  return *found;
}

void read_moment(const VtuGrid& grid, Frame& frame) {
  if (field(grid, "step").tuples() != 1 || field(grid, "TimeValue").tuples() != 1) {
    throw IoError("a frame has one step and one time");
  }
  frame.step = column_values<std::int64_t>(grid.field_data, "step", 1)[0];
  frame.time = column_values<double>(grid.field_data, "TimeValue", 1)[0];
  frame.boundary_poses = poses_from_column(field(grid, "boundary_poses"));
}

}  // namespace

/// The indices are replaced one after the other, so one may be a frame ahead: only what all of them have counts.
RecordedRun::RecordedRun(std::filesystem::path folder) : folder_(std::move(folder)), scene_(read_scene_table(folder_)) {
  const FilesByTime elements = read_index(folder_ / "elements.pvd"), ghosts = read_index(folder_ / "ghosts.pvd");
  const bool bonded = std::filesystem::exists(folder_ / "bonds.pvd");
  const FilesByTime bonds = bonded ? read_index(folder_ / "bonds.pvd") : FilesByTime{};
  for (const auto& [time, file] : elements) {
    if (!ghosts.contains(time) || (bonded && !bonds.contains(time))) continue;
    times_.push_back(time);
    elements_.push_back(file);
    ghosts_.push_back(ghosts.at(time));
    if (bonded) bonds_.push_back(bonds.at(time));
  }
  if (times_.empty()) {
    throw IoError(fmt::format("{}: holds no frames that the indices of ghosts and bonds have as well",
                              (folder_ / "elements.pvd").string()));
  }
}

Frame RecordedRun::frame(std::size_t number) const {
  Frame frame;
  const auto elements = folder_ / elements_.at(number), ghosts = folder_ / ghosts_.at(number);
  const VtuGrid grid = read_vtu(elements), ghost_grid = read_vtu(ghosts);
  naming(elements, [&] {
    read_moment(grid, frame);
    frame.elements = bodies_of(grid, scene_);
  });
  naming(ghosts, [&] { frame.ghosts = bodies_of(ghost_grid, scene_); });
  if (!bonds_.empty()) {
    const auto bonds = folder_ / bonds_[number];
    const VtuGrid bond_grid = read_vtu(bonds);
    frame.bonds = naming(bonds, [&] { return column_values<std::uint32_t>(bond_grid.cell_data, "bond", 1); });
  }
  return frame;
}

}  // namespace moraine
