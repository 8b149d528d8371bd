// SPDX-License-Identifier: Apache-2.0
// A depth buffer that solids are drawn into, shaded afterwards.
#pragma once

#include <cstdint>
#include <vector>

#include "output/picture/camera.hpp"
#include "output/picture/image.hpp"
#include "output/picture/outline.hpp"
#include "output/picture/solid.hpp"

namespace moraine {

class Canvas {
 public:
  Canvas(int width, int height);

  /// A sphere of at least one pixel. Cost: its pixels.
  void ball(const Camera& camera, const Vec3& centre, double radius, std::uint32_t colour);
  /// Any solid, one ray per pixel of the square around its bounding sphere.
  void solid(const Camera& camera, const Pose& pose, double bounding_radius, const std::vector<SolidPart>& parts,
             std::uint32_t colour);
  /// What was drawn, with corners darkened over a reach of `reach` pixels; white where nothing is.
  Image shaded(int reach) const;
  /// Lines over a shaded image: of strength `front` where nothing hides them, `hidden` elsewhere (0 .. 1).
  void lines(Image& image, const Camera& camera, const std::vector<Edge>& edges, double front, double hidden) const;

 private:
  struct Span {
    int begin, end;
  };
  Span columns(double middle, double radius) const;
  Span rows(double middle, double radius) const;
  void put(std::size_t pixel, float depth, const Vec3& normal, std::uint32_t colour);
  std::vector<float> mean_depth(int reach) const;
  bool covered(std::size_t pixel) const;

  int width_, height_;
  std::vector<float> depth_;  ///< towards the viewer [pixels]
  std::vector<float> light_;
  std::vector<std::uint32_t> colour_;
};

/// Half the width and height: each pixel the mean of four.
Image halved(const Image& image);

}  // namespace moraine
