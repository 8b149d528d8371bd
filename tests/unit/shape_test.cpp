// SPDX-License-Identifier: Apache-2.0
#include "physics/shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/errors.hpp"
#include "physics/hull.hpp"

namespace moraine {
namespace {

using std::numbers::pi;

ConvexHull box_corners(const Vec3& half, const Pose& pose = {}) {
  ConvexHull hull;
  for (int c = 0; c < 8; ++c) {
    const Vec3 sign(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1);
    hull.vertices.push_back(pose.position + pose.orientation * half.cwiseProduct(sign));
  }
  return hull;
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " against " << b.transpose();
}

TEST(Shape, SphereHasItsClosedForm) {
  const Shape s = make_shape(Sphere{2});
  EXPECT_DOUBLE_EQ(s.volume, 32.0 / 3.0 * pi);
  expect_near(s.inertia_per_mass, Vec3::Constant(0.4 * 4), 1e-14);
  EXPECT_EQ(s.bounding_radius, 2);
}

TEST(Shape, CuboidHasItsClosedForm) {
  const Shape s = make_shape(Cuboid{{1, 2, 3}});
  EXPECT_DOUBLE_EQ(s.volume, 48);
  expect_near(s.inertia_per_mass, Vec3(4 + 9, 1 + 9, 1 + 4) / 3, 1e-14);
  EXPECT_DOUBLE_EQ(s.bounding_radius, std::sqrt(14));
}

TEST(Shape, CapsuleAgreesWithNumericalIntegration) {
  const double r = 0.7, h = 1.1;
  double volume = 0, across = 0, along = 0;
  const int slices = 200000;
  const double dz = 2 * (h + r) / slices;
  for (int i = 0; i < slices; ++i) {
    const double z = -h - r + (i + 0.5) * dz;
    const double cap = std::max(0.0, std::abs(z) - h);
    const double disc2 = r * r - cap * cap;
    const double slice = pi * disc2 * dz;
    volume += slice;
    along += slice * disc2 / 2;
    across += slice * (disc2 / 4 + z * z);
  }
  const Shape s = make_shape(Capsule{r, h});
  EXPECT_NEAR(s.volume, volume, 1e-8);
  expect_near(s.inertia_per_mass, Vec3(across, across, along) / volume, 1e-8);
  EXPECT_DOUBLE_EQ(s.bounding_radius, r + h);
}

TEST(Shape, HullOfABoxIsTheBoxWhereverItWasWritten) {
  const Vec3 half(0.5, 1, 2);
  const Pose written{{10, -20, 30}, Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};
  Pose frame;
  const Shape hull = make_shape(box_corners(half, written), &frame);
  const Shape box = make_shape(Cuboid{half});
  EXPECT_NEAR(hull.volume, box.volume, 1e-10);
  expect_near(frame.position, written.position, 1e-10);
  Vec3 sorted = box.inertia_per_mass;  // principal moments come in rising order
  std::sort(sorted.begin(), sorted.end());
  expect_near(hull.inertia_per_mass, sorted, 1e-10);
  EXPECT_NEAR(hull.bounding_radius, box.bounding_radius, 1e-10);
}

TEST(Shape, KeepsAxesThatArePrincipal) {
  Pose frame;
  make_shape(box_corners({3, 2, 1}), &frame);
  EXPECT_EQ(frame.orientation.coeffs(), Quat::Identity().coeffs());
  EXPECT_EQ(frame.position, Vec3::Zero());
}

TEST(Shape, HullDropsInnerPoints) {
  ConvexHull points = box_corners({1, 1, 1});
  points.vertices.emplace_back(0.1, 0.2, 0.3);
  points.vertices.emplace_back(0, 0, 0);
  const Shape s = make_shape(points);
  EXPECT_EQ(std::get<ConvexHull>(s.geometry).vertices.size(), 8u);
}

TEST(Shape, HullTrianglesFaceOutward) {
  const HullMesh mesh = convex_hull(box_corners({1, 2, 3}, {{5, 5, 5}, Quat::Identity()}).vertices);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    EXPECT_GT((b - a).cross(c - a).dot(a - Vec3(5, 5, 5)), 0);
  }
}

TEST(Shape, TetrahedronHasItsClosedForm) {
  const Shape s = make_shape(ConvexHull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  EXPECT_NEAR(s.volume, 1.0 / 6, 1e-15);
  // About the centroid the tensor has 3/40 on its diagonal and 1/80 off it.
  expect_near(s.inertia_per_mass, {1.0 / 16, 1.0 / 16, 1.0 / 10}, 1e-14);
}

TEST(Shape, CompoundAddsPartsWithParallelAxes) {
  Compound two;
  two.parts.push_back({Sphere{0.5}, {{1, 0, 0}, Quat::Identity()}});
  two.parts.push_back({Sphere{0.5}, {{3, 0, 0}, Quat::Identity()}});
  Pose frame;
  const Shape s = make_shape(two, &frame);
  expect_near(frame.position, {2, 0, 0}, 1e-14);
  expect_near(s.inertia_per_mass, {0.1, 1.1, 1.1}, 1e-14);
  EXPECT_DOUBLE_EQ(s.bounding_radius, 1.5);
  EXPECT_DOUBLE_EQ(s.volume, pi / 3);
}

TEST(Shape, CompoundOfUnequalPartsHasItsCentreOfMassAtTheOrigin) {
  Compound hammer;
  hammer.parts.push_back({Cuboid{{1, 0.1, 0.1}}, {}});
  hammer.parts.push_back({Capsule{0.3, 0.4}, {{1, 0, 0.2}, Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX()))}});
  const Shape once = make_shape(hammer);
  Pose again;
  make_shape(once.geometry, &again);
  EXPECT_LE(again.position.norm(), 1e-12);
  EXPECT_EQ(again.orientation.coeffs(), Quat::Identity().coeffs());
}

TEST(Shape, ScaleDoesNotMatter) {
  for (const double scale : {1e-6, 1.0, 1e3}) {
    const Shape s = make_shape(box_corners(scale * Vec3(1, 2, 3)));
    EXPECT_NEAR(s.volume / (scale * scale * scale), 48, 1e-9);
  }
}

TEST(Shape, RefusesWhatIsNoSolid) {
  const double nan = std::nan("");
  EXPECT_THROW(make_shape(Sphere{0}), InputError);
  EXPECT_THROW(make_shape(Sphere{-1}), InputError);
  EXPECT_THROW(make_shape(Sphere{nan}), InputError);
  EXPECT_THROW(make_shape(Cuboid{{1, 0, 1}}), InputError);
  EXPECT_THROW(make_shape(Capsule{1, nan}), InputError);
  EXPECT_THROW(make_shape(Compound{}), InputError);
  EXPECT_THROW(make_shape(ConvexHull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}), InputError);
  EXPECT_THROW(make_shape(ConvexHull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}), InputError);
  EXPECT_THROW(make_shape(ConvexHull{{{0, 0, nan}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}}}), InputError);
}

}  // namespace
}  // namespace moraine
