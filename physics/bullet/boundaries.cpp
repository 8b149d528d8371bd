// SPDX-License-Identifier: Apache-2.0
// Boundaries of a Bullet world: a copy of each in every world, moving as prescribed.
#include "physics/bullet/settings.hpp"
#include "physics/bullet/world.hpp"

namespace moraine::bullet {
namespace {

OwnedShape boundary_shape(const Boundary& b, const Scene& scene, double scale) {
  if (const auto* plane = std::get_if<Plane>(&b.geometry)) return make_shape(*plane, scale);
  if (const auto* mesh = std::get_if<TriangleMesh>(&b.geometry)) return make_shape(*mesh, scale);
  return make_shape(scene.shapes[std::get<Solid>(b.geometry).shape].geometry, scale);
}

}  // namespace

btCollisionShape* BulletWorld::shape(std::uint32_t index) {
  OwnedShape& owned = shapes_[index];
  if (!owned.shape) owned = make_shape(settings_.scene->shapes[index].geometry, 1 / units_.length);
  return owned.shape.get();
}

/// A plane is placed at the foot of the perpendicular from the sub-model's origin, where float32 is finest.
Pose BulletWorld::boundary_pose(const Boundary& boundary, double t) const {
  Pose pose = boundary.motion.pose(boundary.pose, t);
  if (const auto* plane = std::get_if<Plane>(&boundary.geometry)) {
    const Vec3 normal = pose.orientation * plane->normal.normalized();
    const Vec3 through = pose.position + pose.orientation * plane->point;
    const Vec3 here = units_.position(btVector3(0, 0, 0));
    pose.position = here + normal * normal.dot(through - here);
  }
  return pose;
}

void BulletWorld::add_boundaries() {
  for (const Boundary& b : settings_.scene->boundaries) {
    boundary_shapes_.push_back(boundary_shape(b, *settings_.scene, 1 / units_.length));
    auto e = std::make_unique<Entry>();
    e->tag = {BodyTag::boundary_bit | boundaries_.size(), b.material, 0, false};
    e->body = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, boundary_shapes_.back().shape.get()));
    e->body->setUserPointer(&e->tag);
    apply_body_settings(*e->body, true);
    if (b.motion.moves()) e->body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    e->body->setCenterOfMassTransform(units_.pose(boundary_pose(b, 0)));
    dynamics_.addRigidBody(e->body.get(), boundary_group, real_group);
    boundaries_.push_back(std::move(e));
  }
}

/// Driven boundaries stand where they are at the start of the step and have the step's mean velocity.
void BulletWorld::move_boundaries(double t) {
  for (std::size_t i = 0; i < boundaries_.size(); ++i) {
    const Boundary& b = settings_.scene->boundaries[i];
    if (!b.motion.moves()) continue;
    const Vec3 from = b.motion.pose(b.pose, t).position;
    const Vec3 to = b.motion.pose(b.pose, t + settings_.substep).position;
    const Twist middle = b.motion.twist(b.pose, t + settings_.substep / 2);
    const Pose placed = boundary_pose(b, t);
    const Vec3 velocity = (to - from) / settings_.substep + middle.angular.cross(placed.position - from);
    btRigidBody& body = *boundaries_[i]->body;
    body.setCenterOfMassTransform(units_.pose(placed));
    body.setLinearVelocity(Units::raw(Vec3(velocity / units_.velocity())));
    body.setAngularVelocity(Units::raw(Vec3(middle.angular * units_.time)));
  }
}

}  // namespace moraine::bullet
