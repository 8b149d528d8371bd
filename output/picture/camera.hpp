// SPDX-License-Identifier: Apache-2.0
// A parallel view from above, like a block diagram's.
#pragma once

#include "physics/types.hpp"

namespace moraine {

/// World to pixels: x to the right, y down, z towards the viewer, all in pixels.
struct Camera {
  Vec3 right, up, toward;  ///< unit vectors of the picture, in the world
  Vec3 centre;             ///< the world point in the middle of the picture [m]
  double scale = 1;        ///< pixels per metre
  double middle_x = 0, middle_y = 0;

  Vec3 project(const Vec3& p) const {
    const Vec3 d = (p - centre) * scale;
    return {middle_x + right.dot(d), middle_y - up.dot(d), toward.dot(d)};
  }
  /// A unit vector of the world in the picture's right, up, toward.
  Vec3 turn(const Vec3& v) const { return {right.dot(v), up.dot(v), toward.dot(v)}; }
};

/// Looks at `box` so that its longer horizontal side runs across a picture of the given width, no higher than
/// max_height; middle_y is half the height it takes. Up is against gravity; z if there is none.
Camera block_view(const Bounds& box, const Vec3& gravity, int width, int max_height, int margin);

}  // namespace moraine
