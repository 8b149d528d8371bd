// SPDX-License-Identifier: Apache-2.0
#include "output/vtu.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>

#include "output/file.hpp"
#include "output/zlib_blocks.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are in memory");

constexpr std::string_view kAppended = "<AppendedData encoding=\"raw\">\n_";

/// The XML text and the appended bytes grow side by side.
struct Document {
  std::string xml;
  std::string appended;

  void array(const Column& column, std::string_view more = "") {
    xml += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n",
        vtk_type(column), column.name, column.components, more, appended.size());
    appended += pack_blocks(column.bytes());
  }
  void section(const char* name, const std::vector<Column>& columns) {
    xml += fmt::format("<{}>\n", name);
    for (const Column& column : columns) array(column);
    xml += fmt::format("</{}>\n", name);
  }
  void fields(const std::vector<Column>& columns) {
    xml += "<FieldData>\n";
    for (const Column& c : columns) array(c, fmt::format(" NumberOfTuples=\"{}\"", c.tuples()));
    xml += "</FieldData>\n";
  }
};

std::vector<Column> cell_columns(const VtuGrid& grid) {
  const std::size_t per_cell = grid.cell == VtuGrid::Cell::line ? 2 : 1;
  const std::size_t cells = grid.connectivity.size() / per_cell;
  std::vector<std::int64_t> offsets(cells);
  for (std::size_t i = 0; i < cells; ++i) offsets[i] = static_cast<std::int64_t>((i + 1) * per_cell);
  return {{"connectivity", 1, grid.connectivity},
          {"offsets", 1, std::move(offsets)},
          {"types", 1, std::vector<std::uint8_t>(cells, static_cast<std::uint8_t>(grid.cell))}};
}

Document document(const VtuGrid& grid) {
  const std::vector<Column> cells = cell_columns(grid);
  Document d;
  d.xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
  d.fields(grid.field_data);
  d.xml +=
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", grid.points.tuples(), cells.back().tuples());
  d.section("PointData", grid.point_data);
  d.section("CellData", grid.cell_data);
  d.section("Points", {grid.points});
  d.section("Cells", cells);
  d.xml += "</Piece>\n</UnstructuredGrid>\n";
  return d;
}

std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string key = fmt::format(" {}=\"", name);
  const std::size_t begin = tag.find(key);
  const std::size_t end = begin == tag.npos ? tag.npos : tag.find('"', begin + key.size());
  if (end == tag.npos) throw IoError(fmt::format("a tag has no attribute '{}'", name));
  return tag.substr(begin + key.size(), end - begin - key.size());
}

std::size_t count(std::string_view tag, std::string_view name) {
  const std::string_view text = attribute(tag, name);
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw IoError(fmt::format("attribute '{}' is '{}', expected a count", name, text));
  }
  return value;
}

template <class T>
std::vector<T> numbers(const std::string& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

Column::Values values_of(std::string_view type, const std::string& bytes) {
  if (type == "Float64") return numbers<double>(bytes);
  if (type == "Int64") return numbers<std::int64_t>(bytes);
  if (type == "UInt32") return numbers<std::uint32_t>(bytes);
  if (type == "UInt8") return numbers<std::uint8_t>(bytes);
  throw IoError(fmt::format("array type '{}' is not one Moraine writes", type));
}

Column read_array(std::string_view tag, std::string_view appended) {
  const std::string bytes = unpack_blocks(appended, count(tag, "offset"));
  Column column{std::string(attribute(tag, "Name")), count(tag, "NumberOfComponents"),
                values_of(attribute(tag, "type"), bytes)};
  if (column.components == 0) throw IoError(fmt::format("array '{}' has no components", column.name));
  return column;
}

std::vector<Column> read_section(std::string_view xml, const char* name, std::string_view appended) {
  const std::size_t begin = xml.find(fmt::format("<{}>", name)), end = xml.find(fmt::format("</{}>", name));
  if (begin == xml.npos || end == xml.npos || end < begin) throw IoError(fmt::format("there is no <{}>", name));
  std::vector<Column> columns;
  for (std::size_t at = xml.find("<DataArray", begin); at < end; at = xml.find("<DataArray", at + 1)) {
    columns.push_back(read_array(xml.substr(at, xml.find('>', at) - at), appended));
  }
  return columns;
}

VtuGrid parse(std::string_view text) {
  const std::size_t split = text.find(kAppended);
  if (split == text.npos) throw IoError("there is no raw appended data");
  const std::string_view xml = text.substr(0, split), appended = text.substr(split + kAppended.size());
  VtuGrid grid;
  grid.points = read_section(xml, "Points", appended).at(0);
  grid.point_data = read_section(xml, "PointData", appended);
  grid.cell_data = read_section(xml, "CellData", appended);
  grid.field_data = read_section(xml, "FieldData", appended);
  const std::vector<Column> cells = read_section(xml, "Cells", appended);
  grid.connectivity = column_values<std::int64_t>(cells, "connectivity", 1);
  const auto& types = column_values<std::uint8_t>(cells, "types", 1);
  if (!types.empty()) grid.cell = static_cast<VtuGrid::Cell>(types[0]);
  return grid;
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const VtuGrid& grid) {
  const Document d = document(grid);
  OutputFile file(path);
  file.write(d.xml);
  file.write(kAppended);
  file.write(d.appended);
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.close();
}

VtuGrid read_vtu(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  try {
    return parse(text);
  } catch (const std::exception& e) {
    throw IoError(fmt::format("{}: {}", path.string(), e.what()));
  }
}

}  // namespace moraine
