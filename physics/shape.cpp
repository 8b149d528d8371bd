// SPDX-License-Identifier: Apache-2.0
#include "physics/shape.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "physics/errors.hpp"
#include "physics/hull.hpp"

namespace moraine {
namespace {

using Mat3 = Eigen::Matrix3d;
using std::numbers::pi;

/// Volume, centroid and second moments about the centroid of a solid of density 1.
struct Moments {
  double volume = 0;
  Vec3 centre = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
};

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw InputError(std::string(what) + " of a shape is " + std::to_string(value) + ", expected positive and finite");
  }
}

Moments moments(const Sphere& s) {
  require_positive(s.radius, "the radius");
  const double volume = 4.0 / 3.0 * pi * s.radius * s.radius * s.radius;
  return {volume, Vec3::Zero(), Mat3::Identity() * (0.4 * volume * s.radius * s.radius)};
}

Moments moments(const Cuboid& c) {
  for (const double extent : c.half_extents) require_positive(extent, "an edge");
  const double volume = 8.0 * c.half_extents.prod();
  const Vec3 squares = c.half_extents.cwiseProduct(c.half_extents);
  const Vec3 diagonal = volume / 3.0 * (Vec3::Constant(squares.sum()) - squares);
  return {volume, Vec3::Zero(), diagonal.asDiagonal()};
}

/// A cylinder and two half spheres; a half sphere's centroid is 3/8 r from its flat side.
Moments moments(const Capsule& c) {
  require_positive(c.radius, "the radius");
  require_positive(c.half_length, "the length");
  const double r2 = c.radius * c.radius, length = 2 * c.half_length;
  const double cylinder = pi * r2 * length, caps = 4.0 / 3.0 * pi * r2 * c.radius;
  const double arm = c.half_length + 0.375 * c.radius;
  const double across = cylinder * (length * length / 12 + r2 / 4) + caps * (83.0 / 320.0 * r2 + arm * arm);
  const double along = cylinder * r2 / 2 + caps * 0.4 * r2;
  return {cylinder + caps, Vec3::Zero(), Vec3(across, across, along).asDiagonal()};
}

Mat3 inertia_of_covariance(const Mat3& covariance) { return Mat3::Identity() * covariance.trace() - covariance; }

/// Sums the tetrahedra between an inner point and every facet.
Moments moments(const HullMesh& hull) {
  const Vec3 origin = hull.vertices.front();
  const Mat3 unit = (Mat3::Ones() + Mat3::Identity()) / 120.0;  // covariance of the unit corner tetrahedron
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& t : hull.triangles) {
    Mat3 edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = hull.vertices[t[static_cast<std::size_t>(k)]] - origin;
    const double det = edges.determinant();
    volume += det / 6;
    first += det / 24 * edges.rowwise().sum();
    second += det * edges * unit * edges.transpose();
  }
  require_positive(volume, "the volume");
  const Vec3 offset = first / volume;
  return {volume, origin + offset, inertia_of_covariance(second - volume * offset * offset.transpose())};
}

Moments moments(const ConvexHull& hull) { return moments(convex_hull(hull.vertices)); }

Mat3 parallel_axes(double volume, const Vec3& arm) { return volume * inertia_of_covariance(arm * arm.transpose()); }

Moments moments(const Compound& compound) {
  if (compound.parts.empty()) throw InputError("a compound has no parts, expected at least one");
  std::vector<Moments> parts;
  Moments sum;
  for (const Compound::Part& part : compound.parts) {
    Moments m = std::visit([](const auto& p) { return moments(p); }, part.primitive);
    const Mat3 turn = part.pose.orientation.toRotationMatrix();
    m.centre = part.pose.position + turn * m.centre;
    m.inertia = turn * m.inertia * turn.transpose();
    sum.volume += m.volume;
    sum.centre += m.volume * m.centre;
    parts.push_back(m);
  }
  sum.centre /= sum.volume;
  for (const Moments& m : parts) sum.inertia += m.inertia + parallel_axes(m.volume, m.centre - sum.centre);
  return sum;
}

/// Axes in the order of rising moments, each with its largest component positive, right-handed.
/// The identity if the tensor is diagonal already.
Quat principal_axes(const Mat3& inertia) {
  const Mat3 off = inertia - Mat3(inertia.diagonal().asDiagonal());
  if (off.cwiseAbs().maxCoeff() <= 1e-9 * inertia.trace()) return Quat::Identity();
  Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvectors();
  for (int k = 0; k < 2; ++k) {
    Eigen::Index largest = 0;
    axes.col(k).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, k) < 0) axes.col(k) *= -1;
  }
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return Quat(axes).normalized();
}

double reach(const Sphere& s, const Pose& pose) { return pose.position.norm() + s.radius; }

double reach(const Cuboid& c, const Pose& pose) {
  double furthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    furthest = std::max(furthest, (pose.position + pose.orientation * c.half_extents.cwiseProduct(sign)).norm());
  }
  return furthest;
}

double reach(const Capsule& c, const Pose& pose) {
  const Vec3 axis = pose.orientation * Vec3(0, 0, c.half_length);
  return std::max((pose.position + axis).norm(), (pose.position - axis).norm()) + c.radius;
}

double reach(const ConvexHull& hull, const Pose& pose) {
  double furthest = 0;
  for (const Vec3& v : hull.vertices) furthest = std::max(furthest, (pose.position + pose.orientation * v).norm());
  return furthest;
}

double reach(const Compound& compound, const Pose&) {
  double furthest = 0;
  for (const auto& part : compound.parts) {
    furthest = std::max(furthest, std::visit([&](const auto& p) { return reach(p, part.pose); }, part.primitive));
  }
  return furthest;
}

void keep_corners(ConvexHull& hull) { hull.vertices = convex_hull(hull.vertices).vertices; }

void keep_corners(Geometry& geometry) {
  if (auto* hull = std::get_if<ConvexHull>(&geometry)) keep_corners(*hull);
  if (auto* compound = std::get_if<Compound>(&geometry)) {
    for (auto& part : compound->parts) {
      if (auto* hull = std::get_if<ConvexHull>(&part.primitive)) keep_corners(*hull);
    }
  }
}

/// Expresses the geometry in `frame`. Spheres, boxes and capsules are in theirs already.
void move_into(const Pose& frame, Geometry& geometry) {
  const Quat back = frame.orientation.conjugate();
  if (auto* hull = std::get_if<ConvexHull>(&geometry)) {
    for (Vec3& v : hull->vertices) v = back * (v - frame.position);
  }
  if (auto* compound = std::get_if<Compound>(&geometry)) {
    for (auto& part : compound->parts) {
      part.pose.position = back * (part.pose.position - frame.position);
      part.pose.orientation = (back * part.pose.orientation).normalized();
    }
  }
}

}  // namespace

Shape make_shape(Geometry geometry, Pose* frame) {
  keep_corners(geometry);
  const Moments m = std::visit([](const auto& g) { return moments(g); }, geometry);
  require_positive(m.volume, "the volume");
  Pose own{m.centre, principal_axes(m.inertia)};
  if (own.position.norm() <= 1e-12 * std::cbrt(m.volume)) own.position.setZero();
  move_into(own, geometry);

  const Mat3 axes = own.orientation.toRotationMatrix();
  Shape shape;
  shape.volume = m.volume;
  shape.inertia_per_mass = (axes.transpose() * m.inertia * axes).diagonal() / m.volume;
  shape.bounding_radius = std::visit([](const auto& g) { return reach(g, Pose{}); }, geometry);
  shape.geometry = std::move(geometry);
  require_positive(shape.bounding_radius, "the size");
  require_positive(shape.inertia_per_mass.minCoeff(), "the inertia");
  if (frame) *frame = own;
  return shape;
}

}  // namespace moraine
