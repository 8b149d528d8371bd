// SPDX-License-Identifier: Apache-2.0
#include "physics/ode/geometry.hpp"

namespace moraine::ode {
namespace {

dGeomID create(const Sphere& s, double scale) { return dCreateSphere(nullptr, s.radius * scale); }
dGeomID create(const Cuboid& c, double scale) {
  const Vec3 size = 2 * scale * c.half_extents;
  return dCreateBox(nullptr, size.x(), size.y(), size.z());
}
dGeomID create(const Capsule& c, double scale) {
  return dCreateCapsule(nullptr, c.radius * scale, 2 * c.half_length * scale);
}
dGeomID create(const ConvexHull&, double) { return nullptr; }  // refused by supports()

Geom fixed(const Primitive& primitive, double scale, dBodyID body) {
  Geom geom(std::visit([&](const auto& p) { return create(p, scale); }, primitive));
  dGeomSetBody(geom.get(), body);
  return geom;
}

struct Numbers {
  dQuaternion q;
  explicit Numbers(const Quat& o) : q{o.w(), o.x(), o.y(), o.z()} {}
};

/// A rod lies along z in its own frame.
Pose rod_pose(const native::Rod& rod) {
  return {0.5 * (rod.from + rod.to), Quat::FromTwoVectors(Vec3::UnitZ(), rod.to - rod.from)};
}

void place_piece(dGeomID geom, const native::HalfSpace& s, double scale, const Pose& pose) {
  const Vec3 normal = pose.orientation * s.normal;
  const double height = normal.dot(pose.position + pose.orientation * (scale * s.point));
  dGeomPlaneSetParams(geom, normal.x(), normal.y(), normal.z(), height);
}
void place_piece(dGeomID geom, const Pose& local, double scale, const Pose& pose) {
  place(geom, {pose.position + pose.orientation * (scale * local.position), pose.orientation * local.orientation});
}
void place_piece(dGeomID geom, const native::Block& s, double scale, const Pose& pose) {
  place_piece(geom, s.pose, scale, pose);
}
void place_piece(dGeomID geom, const native::Rod& s, double scale, const Pose& pose) {
  place_piece(geom, s.from == s.to ? Pose{s.from, Quat::Identity()} : rod_pose(s), scale, pose);
}
void place_piece(dGeomID, const native::Triangle&, double, const Pose&) {}  // part of a Mesh

dGeomID create(const native::HalfSpace& s, double) {
  return dCreatePlane(nullptr, s.normal.x(), s.normal.y(), s.normal.z(), 0);
}
dGeomID create(const native::Block& s, double scale) { return create(Cuboid{s.half_extents}, scale); }
dGeomID create(const native::Rod& s, double scale) {
  const double length = (s.to - s.from).norm();
  return length > 0 ? create(Capsule{s.radius, length / 2}, scale) : create(Sphere{s.radius}, scale);
}
dGeomID create(const native::Triangle&, double) { return nullptr; }

}  // namespace

std::vector<Geom> make_parts(const Geometry& geometry, double scale, dBodyID body) {
  std::vector<Geom> out;
  if (const auto* compound = std::get_if<Compound>(&geometry)) {
    for (const Compound::Part& part : compound->parts) {
      out.push_back(fixed(part.primitive, scale, body));
      const Vec3 at = scale * part.pose.position;
      dGeomSetOffsetPosition(out.back().get(), at.x(), at.y(), at.z());
      dGeomSetOffsetQuaternion(out.back().get(), Numbers(part.pose.orientation).q);
    }
    return out;
  }
  const auto single = [&](const auto& g) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(g)>, Compound>) out.push_back(fixed(Primitive(g), scale, body));
  };
  std::visit(single, geometry);
  return out;
}

Mesh::Mesh(std::span<const native::Surface> triangles, double scale) : data_(dGeomTriMeshDataCreate()) {
  for (const native::Surface& s : triangles)
    for (const Vec3& corner : std::get<native::Triangle>(s).corners) {
      index_.push_back(static_cast<dTriIndex>(index_.size()));
      for (const double x : Vec3(scale * corner)) corners_.push_back(x);
    }
  dGeomTriMeshDataBuildDouble(data_.get(), corners_.data(), 3 * sizeof(double), static_cast<int>(index_.size()),
                              index_.data(), static_cast<int>(index_.size()), 3 * sizeof(dTriIndex));
  geom_.reset(dCreateTriMesh(nullptr, data_.get(), nullptr, nullptr, nullptr));
}

Geom make_piece(const native::Surface& surface, double scale) {
  return Geom(std::visit([&](const auto& s) { return create(s, scale); }, surface));
}

void place_piece(dGeomID geom, const native::Surface& surface, double scale, const Pose& pose) {
  std::visit([&](const auto& s) { place_piece(geom, s, scale, pose); }, surface);
}

void place(dGeomID geom, const Pose& pose) {
  dGeomSetPosition(geom, pose.position.x(), pose.position.y(), pose.position.z());
  dGeomSetQuaternion(geom, Numbers(pose.orientation).q);
}

}  // namespace moraine::ode
