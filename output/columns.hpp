// SPDX-License-Identifier: Apache-2.0
// A frame as named columns of numbers: what every table-like format writes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "output/frame.hpp"

namespace moraine {

/// A named array of tuples, stored tuple after tuple.
struct Column {
  using Values = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::uint32_t>,
                              std::vector<std::uint8_t>>;
  std::string name;
  std::size_t components = 1;
  Values values;

  std::size_t tuples() const;
  std::string_view bytes() const;
};

/// Float64, Int64, UInt32 or UInt8: VTK's name of the column's type.
const char* vtk_type(const Column& column);

/// The centres of mass, three components [m].
Column position_column(const Frame::Bodies& bodies);

/// Every array of a body but its position, one tuple per body: id, sub_model, shape (row of the shape table),
/// shape_kind (0 sphere, 1 box, 2 capsule, 3 hull, 4 compound), radius (bounding) [m], orientation (w x y z),
/// velocity [m/s], angular_velocity [rad/s].
std::vector<Column> body_columns(const Scene& scene, const Frame::Bodies& bodies);

/// The reverse of position_column and body_columns. Errors: IoError if an array is missing or of the wrong kind.
Frame::Bodies bodies_from_columns(const Column& position, const std::vector<Column>& columns);

/// Seven components per boundary: position x y z [m], orientation w x y z.
Column boundary_column(const std::vector<Pose>& poses);
std::vector<Pose> poses_from_column(const Column& column);

/// The column of that name. Errors: IoError if there is none or it holds other numbers than T or other tuples.
template <class T>
const std::vector<T>& column_values(const std::vector<Column>& columns, std::string_view name, std::size_t components);

}  // namespace moraine
