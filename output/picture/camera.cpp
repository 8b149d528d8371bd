// SPDX-License-Identifier: Apache-2.0
#include "output/picture/camera.hpp"

#include <algorithm>
#include <cmath>

namespace moraine {
namespace {

/// How far the eye stands to the side, in front and above, before normalising.
constexpr double kSide = 0.38, kFront = 1.0, kAbove = 0.62;

/// The axis most opposed to gravity, with sign.
Vec3 upward(const Vec3& gravity) {
  if (gravity.isZero(0)) return Vec3::UnitZ();
  int axis;
  gravity.cwiseAbs().maxCoeff(&axis);
  return -std::copysign(1.0, gravity[axis]) * Vec3::Unit(axis);
}

/// The longer of the two axes square to `up`.
Vec3 across(const Vec3& up, const Vec3& size) {
  int vertical, longest;
  up.cwiseAbs().maxCoeff(&vertical);
  Vec3 horizontal = size;
  horizontal[vertical] = -1;
  horizontal.maxCoeff(&longest);
  return Vec3::Unit(longest);
}

Bounds projected(const Camera& camera, const Bounds& box) {
  Bounds seen;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = corner >> axis & 1 ? box.max[axis] : box.min[axis];
    seen.add(camera.project(p));
  }
  return seen;
}

}  // namespace

Camera block_view(const Bounds& box, const Vec3& gravity, int width, int max_height, int margin) {
  const Vec3 above = upward(gravity), side = across(above, box.max - box.min), back = above.cross(side);
  Camera camera;
  camera.toward = (kSide * side - kFront * back + kAbove * above).normalized();
  camera.right = above.cross(camera.toward).normalized();
  camera.up = camera.toward.cross(camera.right);
  camera.centre = (box.min + box.max) / 2;
  const Bounds seen = projected(camera, box);
  const Vec3 size = seen.max - seen.min;
  camera.scale = std::min((width - 2 * margin) / size.x(), (max_height - 2 * margin) / size.y());
  camera.middle_x = width / 2.0;
  camera.middle_y = camera.scale * size.y() / 2 + margin;
  return camera;
}

}  // namespace moraine
