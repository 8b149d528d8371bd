// SPDX-License-Identifier: Apache-2.0
#include "ghosting/admission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ghosting/auto_count.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

void check_abilities(const Scene& scene, const Engine& engine) {
  for (const Element& e : scene.elements)
    if (!engine.supports(scene.shapes[e.shape].geometry))
      throw InputError(
          fmt::format("{}: element {} has a shape that engine {} cannot do", scene.source, e.id, engine.name));
  if (!engine.bonds && !scene.bonds.empty())
    throw InputError(
        fmt::format("{}: engine {} has no bonds, the scene has {}", scene.source, engine.name, scene.bonds.size()));
}

void check_step(const Scene& scene, const Engine& engine) {
  const StepLimit limit = engine.step_limit(scene);
  if (scene.time.substep() <= limit.substep) return;
  throw InputError(
      fmt::format("{}: a substep of {:.4g} s is too long for engine {}: the limit is {:.4g} s, set by {}; use "
                  "a smaller time.dt or at least {:.0f} substeps",
                  scene.source, scene.time.substep(), engine.name, limit.substep, limit.reason,
                  std::ceil(scene.time.dt / limit.substep)));
}

/// Where the plane is next to the box.
Bounds beside(const Plane& plane, const Pose& pose, const Bounds& box) {
  const Vec3 normal = pose.orientation * plane.normal.normalized();
  const Vec3 through = pose.position + pose.orientation * plane.point;
  Bounds feet;
  for (const double x : {box.min.x(), box.max.x()})
    for (const double y : {box.min.y(), box.max.y()})
      for (const double z : {box.min.z(), box.max.z()})
        feet.add(Vec3(x, y, z) - normal * normal.dot(Vec3(x, y, z) - through));
  return feet;
}

Bounds bounds_of(const Boundary& b, const Scene& scene, const Bounds& elements) {
  if (const auto* plane = std::get_if<Plane>(&b.geometry)) return beside(*plane, b.pose, elements);
  Bounds box;
  if (const auto* mesh = std::get_if<TriangleMesh>(&b.geometry))
    for (const Vec3& v : mesh->vertices) box.add(b.pose.position + b.pose.orientation * v);
  else
    box.add(b.pose.position, scene.shapes[std::get<Solid>(b.geometry).shape].bounding_radius);
  return box;
}

/// The elements, and what they can fall on.
Bounds whole(const Scene& scene) {
  Bounds elements;
  for (const Element& e : scene.elements) elements.add(e.state.pose.position, scene.shape_of(e).bounding_radius);
  if (elements.empty()) return elements;
  Bounds box = elements;
  for (const Boundary& b : scene.boundaries) box.add(bounds_of(b, scene, elements));
  return box;
}

}  // namespace

Limits find_limits(std::string_view profile) {
  if (profile == "default") return {};
  // PhysX as Longshaw et al. (2009) used it: 64 scenes, 64,000 shapes, 256,000 contact pairs per scene. A packed sphere
  // takes part in 12 pairs, hence 21,333 of them. A tenth is kept free for ghosts, several times what a compact cut of
  // that size needs.
  if (profile == "physx") return {64'000, 256'000, 64, 0.1};
  throw InputError(fmt::format("unknown engine profile '{}', expected one of: default, physx", profile));
}

void check_engine(const Scene& scene, const Engine& engine) {
  check_abilities(scene, engine);
  check_step(scene, engine);
  engine.check(scene);
}

std::size_t part_count(const Scene& scene, const Engine& engine, const Limits& limits) {
  const auto asked = static_cast<std::size_t>(std::max(0, scene.run.sub_models));
  const std::size_t parts = asked > 0 ? asked : auto_count(scene.elements.size(), engine, limits);
  if (parts > limits.worlds)
    throw InputError(
        fmt::format("{}: {} sub-models are more than the {} worlds that engine {} ({}) allows in a process",
                    scene.source, parts, limits.worlds, engine.name, scene.run.engine_profile));
  const double capacity = static_cast<double>(limits.packed_spheres()) * (1 - limits.ghost_reserve);
  const double largest = std::ceil(static_cast<double>(scene.elements.size()) / static_cast<double>(parts));
  if (largest > capacity)
    throw InputError(
        fmt::format("{}: {:.0f} elements per sub-model are more than engine {} ({}) holds: {} touching elements, "
                    "{:.0f} % of them kept "
                    "for ghosts; use at least {:.0f} sub-models",
                    scene.source, largest, engine.name, scene.run.engine_profile, limits.packed_spheres(),
                    limits.ghost_reserve * 100, std::ceil(static_cast<double>(scene.elements.size()) / capacity)));
  return parts;
}

double driven_speed(const Scene& scene, const Bounds& box, double from, double to) {
  double speed = 0;
  for (const Boundary& b : scene.boundaries) {
    const Twist& v = b.motion.velocity;
    const double arm = box.empty() ? 0 : box.farthest(b.motion.centre);
    if (b.motion.start < to && b.motion.stop > from) speed = std::max(speed, v.linear.norm() + v.angular.norm() * arm);
  }
  return speed;
}

double runaway_speed(const Scene& scene) {
  if (scene.run.max_speed > 0) return scene.run.max_speed;
  const Bounds box = whole(scene);
  double speed = driven_speed(scene, box, 0, std::numeric_limits<double>::infinity());
  for (const Element& e : scene.elements)
    speed =
        std::max(speed, e.state.twist.linear.norm() + e.state.twist.angular.norm() * scene.shape_of(e).bounding_radius);
  const double extent = box.empty() ? 1.0 : (box.max - box.min).norm();
  const double fall = std::sqrt(2 * scene.gravity.norm() * extent);
  const double bond_speed = scene.typical_diameter() / scene.time.substep();
  return 10 * (speed + fall) + (scene.gravity.isZero() && speed == 0 ? bond_speed : 0);
}

}  // namespace moraine
