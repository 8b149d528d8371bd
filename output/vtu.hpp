// SPDX-License-Identifier: Apache-2.0
// VTK's XML unstructured grid: appended raw data, little endian, UInt64 headers, zlib blocks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "output/columns.hpp"

namespace moraine {

/// Points joined by cells of one kind.
struct VtuGrid {
  enum class Cell : std::uint8_t { vertex = 1, line = 3 };  ///< VTK's numbers; also sets the points per cell
  Cell cell = Cell::vertex;
  Column points{"Points", 3, std::vector<double>{}};
  std::vector<std::int64_t> connectivity;  ///< point numbers, cell after cell
  std::vector<Column> point_data;
  std::vector<Column> cell_data;
  std::vector<Column> field_data;  ///< of the grid as a whole
};

/// Errors: IoError naming the path. Cost: one compression of the arrays (zlib level 1).
void write_vtu(const std::filesystem::path& path, const VtuGrid& grid);

/// Reads what write_vtu wrote; not every .vtu. Errors: IoError naming the path.
VtuGrid read_vtu(const std::filesystem::path& path);

}  // namespace moraine
