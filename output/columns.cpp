// SPDX-License-Identifier: Apache-2.0
#include "output/columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "physics/errors.hpp"

namespace moraine {
namespace {

template <class T, class Get>
Column column_of(const char* name, std::size_t components, std::size_t count, Get&& append) {
  std::vector<T> values;
  values.reserve(components * count);
  for (std::size_t i = 0; i < count; ++i) append(values, i);
  return {name, components, std::move(values)};
}

template <class Get>
Column vector_column(const char* name, const Frame::Bodies& bodies, Get&& get) {
  return column_of<double>(name, 3, bodies.size(), [&](std::vector<double>& values, std::size_t i) {
    const Vec3& v = get(bodies.state[i]);
    values.insert(values.end(), {v.x(), v.y(), v.z()});
  });
}

Column orientation_column(const Frame::Bodies& bodies) {
  return column_of<double>("orientation", 4, bodies.size(), [&](std::vector<double>& values, std::size_t i) {
    const Quat& q = bodies.state[i].pose.orientation;
    values.insert(values.end(), {q.w(), q.x(), q.y(), q.z()});
  });
}

Vec3 vec3_at(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

const Column& find_column(const std::vector<Column>& columns, std::string_view name) {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  if (found == columns.end()) throw IoError(fmt::format("array '{}' is missing", name));
  return *found;
}

template <class T>
const std::vector<T>& typed_values(const Column& column, std::size_t components) {
  const auto* values = std::get_if<std::vector<T>>(&column.values);
  if (!values || column.components != components) {
    throw IoError(fmt::format("array '{}' holds {} x {}", column.name, column.components, vtk_type(column)));
  }
  return *values;
}

void expect_length(const Frame::Bodies& bodies, std::size_t tuples) {
  if (tuples != bodies.size()) throw IoError("arrays differ in length");
}

}  // namespace

std::size_t Column::tuples() const {
  return std::visit([](const auto& v) { return v.size(); }, values) / components;
}

std::string_view Column::bytes() const {
  return std::visit(
      [](const auto& v) { return std::string_view(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(v[0])); },
      values);
}

const char* vtk_type(const Column& column) {
  static constexpr const char* names[] = {"Float64", "Int64", "UInt32", "UInt8"};
  return names[column.values.index()];
}

Column position_column(const Frame::Bodies& bodies) {
  return vector_column("position", bodies, [](const ElementState& s) -> const Vec3& { return s.pose.position; });
}

std::vector<Column> body_columns(const Scene& scene, const Frame::Bodies& bodies) {
  const std::size_t n = bodies.size();
  std::vector<Column> out;  // an initializer list would hold a copy of all of it
  out.push_back({"id", 1, bodies.id});
  out.push_back({"sub_model", 1, bodies.sub_model});
  out.push_back({"shape", 1, bodies.shape});
  out.push_back(column_of<std::uint8_t>("shape_kind", 1, n, [&](auto& values, std::size_t i) {
    values.push_back(static_cast<std::uint8_t>(scene.shapes[bodies.shape[i]].geometry.index()));
  }));
  out.push_back(column_of<double>("radius", 1, n, [&](auto& values, std::size_t i) {
    values.push_back(scene.shapes[bodies.shape[i]].bounding_radius);
  }));
  out.push_back(orientation_column(bodies));
  out.push_back(vector_column("velocity", bodies, [](const ElementState& s) -> const Vec3& { return s.twist.linear; }));
  out.push_back(
      vector_column("angular_velocity", bodies, [](const ElementState& s) -> const Vec3& { return s.twist.angular; }));
  return out;
}

template <class T>
const std::vector<T>& column_values(const std::vector<Column>& columns, std::string_view name, std::size_t components) {
  return typed_values<T>(find_column(columns, name), components);
}

template const std::vector<double>& column_values(const std::vector<Column>&, std::string_view, std::size_t);
template const std::vector<std::int64_t>& column_values(const std::vector<Column>&, std::string_view, std::size_t);
template const std::vector<std::uint32_t>& column_values(const std::vector<Column>&, std::string_view, std::size_t);
template const std::vector<std::uint8_t>& column_values(const std::vector<Column>&, std::string_view, std::size_t);

Frame::Bodies bodies_from_columns(const Column& position, const std::vector<Column>& columns) {
  Frame::Bodies bodies;
  bodies.id = column_values<std::uint32_t>(columns, "id", 1);
  bodies.sub_model = column_values<std::uint32_t>(columns, "sub_model", 1);
  bodies.shape = column_values<std::uint32_t>(columns, "shape", 1);
  const auto& points = typed_values<double>(position, 3);
  const auto& turns = column_values<double>(columns, "orientation", 4);
  const auto& speeds = column_values<double>(columns, "velocity", 3);
  const auto& spins = column_values<double>(columns, "angular_velocity", 3);
  for (std::size_t tuples : {bodies.sub_model.size(), bodies.shape.size(), points.size() / 3, turns.size() / 4,
                             speeds.size() / 3, spins.size() / 3}) {
    expect_length(bodies, tuples);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Quat turn(turns[4 * i], turns[4 * i + 1], turns[4 * i + 2], turns[4 * i + 3]);
    bodies.state.push_back({{vec3_at(points, i), turn}, {vec3_at(speeds, i), vec3_at(spins, i)}});
  }
  return bodies;
}

Column boundary_column(const std::vector<Pose>& poses) {
  return column_of<double>("boundary_poses", 7, poses.size(), [&](std::vector<double>& values, std::size_t i) {
    const auto& [p, q] = poses[i];
    values.insert(values.end(), {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()});
  });
}

std::vector<Pose> poses_from_column(const Column& column) {
  const auto& v = typed_values<double>(column, 7);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i + 7 <= v.size(); i += 7) {
    poses.push_back({Vec3(v[i], v[i + 1], v[i + 2]), Quat(v[i + 3], v[i + 4], v[i + 5], v[i + 6])});
  }
  return poses;
}

}  // namespace moraine
