// SPDX-License-Identifier: Apache-2.0
// The `boundaries` section: planes, containers, meshes and solids, fixed or driven.
#include <fmt/format.h>

#include "physics/scene/draft.hpp"

namespace moraine {
namespace {

/// Sides of a container with inward normals, the +z side last.
std::vector<Plane> box_planes(const Bounds& box, bool open_top) {
  std::vector<Plane> planes;
  for (int a = 0; a < 3; ++a) {
    planes.push_back({box.min, Vec3::Unit(a)});
    if (a < 2 || !open_top) planes.push_back({box.max, -Vec3::Unit(a)});
  }
  return planes;
}

/// Two triangles a side, about the box's middle, counter-clockwise seen from inside; the +z side last.
TriangleMesh box_mesh(const Bounds& box, bool open_top) {
  TriangleMesh mesh;
  const Vec3 half = 0.5 * (box.max - box.min);
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back(half.cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
  }
  mesh.triangles = {{0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}};
  if (open_top) mesh.triangles.resize(10);
  return mesh;
}

Motion read_motion(const Node& node) {
  node.allow({"velocity", "angular_velocity", "centre", "start", "stop", "ramp"});
  Motion motion;
  motion.velocity = read_twist(node);
  motion.centre = node.vector("centre", Vec3::Zero());
  motion.start = node.not_negative("start", 0);
  motion.stop = node.positive("stop", motion.stop);
  motion.ramp = node.not_negative("ramp", 0);
  if (!motion.moves())
    node.fail("the motion has no velocity, expected 'velocity' or 'angular_velocity' that is not zero");
  if (motion.stop <= motion.start) {
    node.at("stop").fail(fmt::format("'stop' is {}, expected later than 'start' ({})", motion.stop, motion.start));
  }
  if (motion.stop - motion.start < 2 * motion.ramp) {
    node.at("ramp").fail(fmt::format("two ramps of {} s do not fit into {} s, expected at most half of it", motion.ramp,
                                     motion.stop - motion.start));
  }
  return motion;
}

/// The motion of an entry; whoever moves must say it is kinematic, and the other way round.
Motion read_drive(const Node& entry) {
  const auto motion = entry.find("motion");
  const bool kinematic = entry.boolean("kinematic", false);
  if (motion && !kinematic)
    motion->fail("a boundary moves that is not kinematic, expected 'kinematic: true' beside 'motion'");
  if (kinematic && !motion)
    entry.at("kinematic").fail("a kinematic boundary does not move, expected 'motion' beside it");
  return motion ? read_motion(*motion) : Motion{};
}

/// Adds boundaries of one entry.
struct Adder {
  Draft& draft;
  std::uint32_t material;
  Motion motion;

  template <class Geometry>
  void add(Geometry geometry, const Pose& pose = {}) const {
    draft.scene.boundaries.push_back({std::move(geometry), pose, material, motion});
  }
  void add_solid(const PlacedShape& shape, const Pose& written) const {
    add(Solid{shape.index}, body_pose(written, shape.frame));
  }
};

void read_plane(const Node& plane, const Adder& adder) {
  plane.allow({"point", "normal"});
  adder.add(Plane{plane.vector("point", Vec3::Zero()), plane.at("normal", "a direction").direction()});
}

void read_container(const Node& entry, const Adder& adder) {
  const Bounds box = entry.at("box").box();
  const bool open_top = entry.boolean("open_top", false);
  if (entry.boolean("triangulated", false)) {
    return adder.add(box_mesh(box, open_top), {0.5 * (box.min + box.max), Quat::Identity()});
  }
  for (const Plane& plane : box_planes(box, open_top)) adder.add(plane);
}

void read_triangles(const Node& entry, const Adder& adder) {
  const Node mesh = entry.at("mesh");
  mesh.allow({"file", "vertices", "triangles"});
  mesh.one_of({"file", "vertices"});
  if (mesh.find("file") && mesh.find("triangles"))
    mesh.fail("a mesh has both a file and triangles, expected one of them");
  adder.add(read_mesh(mesh, adder.draft), read_pose(entry));
}

void read_plate(const Node& plate, const Adder& adder) {
  plate.allow({"size", "at", "rotation"});
  const Vec3 size = plate.at("size", "the lengths of the edges [m]").positive_vector();
  adder.add_solid(add_shape(plate, Cuboid{size / 2}, adder.draft), read_pose(plate));
}

void read_boundary(const Node& entry, Draft& draft) {
  const std::string kind = entry.one_of({"plane", "box", "mesh", "solid", "plate"});
  if (kind == "plane" || kind == "plate") {
    entry.allow({"plane", "plate", "material", "motion", "kinematic"});
  } else if (kind == "box") {
    entry.allow({"box", "triangulated", "open_top", "material", "motion", "kinematic"});
  } else {
    entry.allow({"mesh", "solid", "at", "rotation", "material", "motion", "kinematic"});
  }
  const Adder adder{draft, read_material(entry, draft.scene), read_drive(entry)};
  if (kind == "plane") return read_plane(entry.at(kind), adder);
  if (kind == "box") return read_container(entry, adder);
  if (kind == "mesh") return read_triangles(entry, adder);
  if (kind == "plate") return read_plate(entry.at(kind), adder);
  adder.add_solid(read_shape(entry.at(kind), draft), read_pose(entry));
}

}  // namespace

void read_boundaries(const Node& root, Draft& draft) {
  const auto list = root.find("boundaries");
  if (!list) return;
  for (const Node& entry : list->items("a list of boundaries")) read_boundary(entry, draft);
}

}  // namespace moraine
