// SPDX-License-Identifier: Apache-2.0
#include "physics/errors.hpp"
#include "physics/scene/draft.hpp"
#include "physics/scene/mesh_file.hpp"

namespace moraine {
namespace {

constexpr double radians_per_degree = 0.017453292519943295;

std::vector<Vec3> read_points(const Node& points) {
  std::vector<Vec3> all;
  for (const Node& point : points.items("a list of points [x, y, z]")) all.push_back(point.vector());
  return all;
}

Capsule read_capsule(const Node& node) {
  node.allow({"radius", "length"});
  return {node.at("radius", "the radius [m]").positive(),
          node.at("length", "the length without the caps [m]").positive() / 2};
}

ConvexHull read_hull(const Node& node, const Draft& draft) {
  node.allow({"points", "file"});
  if (node.one_of({"points", "file"}) == "points") return {read_points(node.at("points"))};
  return {read_mesh(node, draft).vertices};
}

Primitive read_primitive(const Node& node, const Draft& draft) {
  const std::string kind = node.one_of({"sphere", "box", "capsule", "hull"});
  const Node value = node.at(kind);
  if (kind == "sphere") return Sphere{value.positive()};
  if (kind == "box") return Cuboid{value.positive_vector() / 2};
  if (kind == "capsule") return read_capsule(value);
  return read_hull(value, draft);
}

Compound read_compound(const Node& node, const Draft& draft) {
  Compound compound;
  for (const Node& part : node.items("a list of parts")) {
    part.allow({"sphere", "box", "capsule", "hull", "at", "rotation"});
    compound.parts.push_back({read_primitive(part, draft), read_pose(part)});
  }
  return compound;
}

Geometry read_geometry(const Node& shape, const Draft& draft) {
  shape.allow({"sphere", "box", "capsule", "hull", "compound"});
  if (shape.one_of({"sphere", "box", "capsule", "hull", "compound"}) == "compound") {
    return read_compound(shape.at("compound"), draft);
  }
  return std::visit([](auto&& primitive) -> Geometry { return primitive; }, read_primitive(shape, draft));
}

/// Runs what may fail without knowing where; the error gets the place of `node`.
template <class Work>
auto placed(const Node& node, const Work& work) {
  try {
    return work();
  } catch (const InputError& e) {
    node.fail(e.what());
  }
}

void check_triangles(const Node& list, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) list.fail("a mesh without triangles, expected at least one");
}

}  // namespace

Pose read_pose(const Node& entry) {
  Pose pose;
  pose.position = entry.vector("at", Vec3::Zero());
  if (const auto rotation = entry.find("rotation")) {
    rotation->allow({"axis", "angle"});
    const double angle = rotation->at("angle", "an angle in degrees").number() * radians_per_degree;
    pose.orientation = Eigen::AngleAxisd(angle, rotation->at("axis", "a direction").direction());
  }
  return pose;
}

Twist read_twist(const Node& entry) {
  return {entry.vector("velocity", Vec3::Zero()), entry.vector("angular_velocity", Vec3::Zero())};
}

PlacedShape add_shape(const Node& node, Geometry geometry, Draft& draft) {
  return placed(node, [&] { return draft.add_shape(std::move(geometry)); });
}

PlacedShape read_shape(const Node& shape, Draft& draft) { return add_shape(shape, read_geometry(shape, draft), draft); }

TriangleMesh read_mesh(const Node& node, const Draft& draft) {
  if (const auto file = node.find("file")) {
    return placed(*file, [&] { return read_mesh(draft.resolve(file->text())); });
  }
  TriangleMesh mesh;
  mesh.vertices = read_points(node.at("vertices", "a list of points"));
  const Node triangles = node.at("triangles", "a list of vertex triples");
  const auto last = static_cast<std::int64_t>(mesh.vertices.size()) - 1;
  for (const Node& triangle : triangles.items("a list of vertex triples")) {
    const std::vector<Node> corners = triangle.items("three vertex numbers", 3);
    auto& t = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) t[k] = static_cast<std::uint32_t>(corners[k].integer(0, last));
  }
  check_triangles(triangles, mesh);
  return mesh;
}

}  // namespace moraine
