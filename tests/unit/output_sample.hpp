// SPDX-License-Identifier: Apache-2.0
// A small scene and frames of it for the tests of what a run leaves behind.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "output/frame.hpp"

namespace moraine::sample {

/// An empty folder, removed with the object.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("moraine_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline Shape shape(Geometry geometry, double bounding_radius) {
  Shape s;
  s.geometry = std::move(geometry);
  s.bounding_radius = bounding_radius;
  return s;
}

inline Compound compound() {
  Compound c;
  c.parts.push_back({Sphere{0.2}, {Vec3(0.2, 0, 0), Quat::Identity()}});
  c.parts.push_back({Cuboid{Vec3(0.1, 0.1, 0.1)}, {Vec3(-0.2, 0, 0), Quat(0.8, 0.6, 0, 0)}});
  return c;
}

/// Every kind of shape, a plane, a mesh and a plate, and a bond between neighbours.
inline Scene scene(ElementId elements = 10) {
  Scene s;
  s.name = "sample";
  s.shapes = {shape(Sphere{0.45}, 0.45),
              shape(Cuboid{Vec3(0.3, 0.2, 0.25)}, 0.44),
              shape(Capsule{0.2, 0.25}, 0.45),
              shape(ConvexHull{{Vec3(0.4, 0, 0), Vec3(-0.4, 0, 0), Vec3(0, 0.4, 0), Vec3(0, -0.4, 0), Vec3(0, 0, 0.4),
                                Vec3(0, 0, -0.4)}},
                    0.4),
              shape(compound(), 0.4),
              shape(Cuboid{Vec3(0.1, 2, 2)}, 3)};
  s.time.dt = 0.5;
  s.time.steps = 120;
  for (ElementId i = 0; i < elements; ++i) {
    Element e;
    e.id = 3 * i + 1;
    e.shape = i % 5;
    s.elements.push_back(e);
    if (i > 0) s.bonds.push_back({e.id - 3, e.id, 1.0, 1e3, 1.0, 1.1});
  }
  Boundary plane, mesh, plate;
  mesh.geometry =
      TriangleMesh{{Vec3(-1, -1, 0), Vec3(11, -1, 0), Vec3(11, 2, 0), Vec3(-1, 2, 0)}, {{0, 1, 2}, {0, 2, 3}}};
  plate.geometry = Solid{5};
  plate.pose.position = Vec3(12, 0, 0);
  s.boundaries = {plane, mesh, plate};
  return s;
}

inline ElementState state(double i) {
  return {{Vec3(i * 1.01, 0.1 * i, 1 / 3.0), Quat(1, 0.1 * i, 0, 0.2).normalized()},
          {Vec3(-i, 1e-300, 2e17), Vec3(i / 7, 0, -1)}};
}

/// The elements of scene(), every fourth a ghost of the next sub-model; the first bond is broken.
inline Frame frame(const Scene& scene, std::int64_t step = 120) {
  Frame f;
  f.step = step;
  f.time = 0.5 * static_cast<double>(step);
  const auto add = [](Frame::Bodies& bodies, const Element& e, SubModelId owner, double at) {
    bodies.id.push_back(e.id);
    bodies.sub_model.push_back(owner);
    bodies.shape.push_back(e.shape);
    bodies.state.push_back(state(at));
  };
  for (std::size_t i = 0; i < scene.elements.size(); ++i) {
    const auto owner = static_cast<SubModelId>(i * 3 / scene.elements.size());
    add(f.elements, scene.elements[i], owner, static_cast<double>(i));
    if (i % 4 == 0) add(f.ghosts, scene.elements[i], owner + 1, static_cast<double>(i));
  }
  for (std::uint32_t b = 1; b < scene.bonds.size(); ++b) f.bonds.push_back(b);
  for (const Boundary& b : scene.boundaries) f.boundary_poses.push_back(b.pose);
  f.boundary_poses.back().position.x() -= f.time / 100;
  return f;
}

inline bool same(const ElementState& a, const ElementState& b) {
  return a.pose.position == b.pose.position && a.pose.orientation.coeffs() == b.pose.orientation.coeffs() &&
         a.twist.linear == b.twist.linear && a.twist.angular == b.twist.angular;
}

}  // namespace moraine::sample
