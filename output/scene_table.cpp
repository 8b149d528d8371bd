// SPDX-License-Identifier: Apache-2.0
#include "output/scene_table.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "output/file.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kName = "shapes.json";

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json json_of(const Pose& pose) {
  const Quat& q = pose.orientation;
  return {{"position", json_of(pose.position)}, {"orientation", {q.w(), q.x(), q.y(), q.z()}}};
}
Json json_of(const std::vector<Vec3>& points) {
  Json list = Json::array();
  for (const Vec3& p : points) list.push_back(json_of(p));
  return list;
}

Json json_of(const Sphere& s) { return {{"sphere", s.radius}}; }
Json json_of(const Cuboid& c) { return {{"box", json_of(c.half_extents)}}; }
Json json_of(const Capsule& c) { return {{"capsule", {c.radius, c.half_length}}}; }
Json json_of(const ConvexHull& h) { return {{"hull", json_of(h.vertices)}}; }
Json json_of(const Compound& compound) {
  Json parts = Json::array();
  for (const Compound::Part& part : compound.parts) {
    parts.push_back({{"primitive", std::visit([](const auto& p) { return json_of(p); }, part.primitive)},
                     {"pose", json_of(part.pose)}});
  }
  return {{"compound", parts}};
}
Json json_of(const Shape& shape) {
  Json j = std::visit([](const auto& g) { return json_of(g); }, shape.geometry);
  j["bounding_radius"] = shape.bounding_radius;
  return j;
}

Json json_of(const Plane& p) { return {{"plane", {{"point", json_of(p.point)}, {"normal", json_of(p.normal)}}}}; }
Json json_of(const TriangleMesh& m) {
  return {{"mesh", {{"vertices", json_of(m.vertices)}, {"triangles", m.triangles}}}};
}
Json json_of(const Solid& s) { return {{"solid", s.shape}}; }
Json json_of(const Boundary& b) {
  Json j = std::visit([](const auto& g) { return json_of(g); }, b.geometry);
  j["pose"] = json_of(b.pose);
  return j;
}

template <class T>
Json list_of(const std::vector<T>& items) {
  Json list = Json::array();
  for (const T& item : items) list.push_back(json_of(item));
  return list;
}

double number(const Json& j) { return j.get<double>(); }
Vec3 vec3_of(const Json& j) { return Vec3(number(j.at(0)), number(j.at(1)), number(j.at(2))); }
Pose pose_of(const Json& j) {
  const Json& q = j.at("orientation");
  return {vec3_of(j.at("position")), Quat(number(q.at(0)), number(q.at(1)), number(q.at(2)), number(q.at(3)))};
}
std::vector<Vec3> points_of(const Json& j) {
  std::vector<Vec3> points;
  for (const Json& p : j) points.push_back(vec3_of(p));
  return points;
}

Primitive primitive_of(const Json& j) {
  if (j.contains("sphere")) return Sphere{number(j["sphere"])};
  if (j.contains("box")) return Cuboid{vec3_of(j["box"])};
  if (j.contains("capsule")) return Capsule{number(j["capsule"].at(0)), number(j["capsule"].at(1))};
  return ConvexHull{points_of(j.at("hull"))};
}

Geometry geometry_of(const Json& j) {
  if (!j.contains("compound")) {
    return std::visit([](auto&& primitive) -> Geometry { return primitive; }, primitive_of(j));
  }
  Compound compound;
  for (const Json& part : j["compound"]) {
    compound.parts.push_back({primitive_of(part.at("primitive")), pose_of(part.at("pose"))});
  }
  return compound;
}

Shape shape_of(const Json& j) {
  Shape shape;
  shape.geometry = geometry_of(j);
  shape.bounding_radius = j.at("bounding_radius");
  return shape;
}

Boundary boundary_of(const Json& j) {
  Boundary boundary;
  boundary.pose = pose_of(j.at("pose"));
  if (j.contains("plane")) {
    boundary.geometry = Plane{vec3_of(j["plane"].at("point")), vec3_of(j["plane"].at("normal"))};
  } else if (j.contains("mesh")) {
    boundary.geometry = TriangleMesh{points_of(j["mesh"].at("vertices")), j["mesh"].at("triangles")};
  } else {
    boundary.geometry = Solid{j.at("solid")};
  }
  return boundary;
}

Scene scene_of(const Json& j) {
  Scene scene;
  scene.name = j.at("name");
  scene.gravity = vec3_of(j.at("gravity"));
  scene.time.dt = j.at("time").at("dt");
  scene.time.steps = j.at("time").at("steps");
  scene.time.label = {j.at("time").at("unit"), j.at("time").at("per_step")};
  for (const Json& shape : j.at("shapes")) scene.shapes.push_back(shape_of(shape));
  for (const Json& boundary : j.at("boundaries")) scene.boundaries.push_back(boundary_of(boundary));
  return scene;
}

}  // namespace

void write_scene_table(const Scene& scene, const std::filesystem::path& folder) {
  const auto& [dt, steps, substeps, label] = scene.time;
  const Json j = {{"name", scene.name},
                  {"gravity", json_of(scene.gravity)},
                  {"time", {{"dt", dt}, {"steps", steps}, {"unit", label.unit}, {"per_step", label.per_step}}},
                  {"shapes", list_of(scene.shapes)},
                  {"boundaries", list_of(scene.boundaries)}};
  replace_file(folder / kName, j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string geometry_text(const Scene& scene) {
  return Json{{"shapes", list_of(scene.shapes)}, {"boundaries", list_of(scene.boundaries)}}.dump();
}

Scene read_scene_table(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kName;
  const std::string text = read_file(path);
  try {
    return scene_of(Json::parse(text));
  } catch (const nlohmann::json::exception& e) {
    throw IoError(fmt::format("{}: not a table of shapes: {}", path.string(), e.what()));
  }
}

}  // namespace moraine
