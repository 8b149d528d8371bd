// SPDX-License-Identifier: Apache-2.0
#include "output/picture/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "output/picture/palette.hpp"

namespace moraine {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
const Vec3 kLight = Vec3(-0.42, 0.66, 0.62).normalized();  // right, up, toward

/// Brightness of a surface from its normal in the picture's axes: much sky, one soft lamp.
float lit(const Vec3& normal) {
  const double lamp = std::max(0.0, normal.dot(kLight));
  return static_cast<float>(0.48 + 0.12 * normal.y() + 0.50 * lamp + 0.12 * std::pow(lamp, 24));
}

std::uint8_t channel(double value) { return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0)); }

Rgb scaled(const Rgb& colour, double by) {
  return {channel(colour[0] * by), channel(colour[1] * by), channel(colour[2] * by)};
}

void blend(Rgb& pixel, double strength) {
  constexpr double ink[] = {52, 56, 66};
  for (int k = 0; k < 3; ++k) pixel[k] = channel(pixel[k] + strength * (ink[k] - pixel[k]));
}

/// The sums of `reach` numbers to either side of each, along a line of `count` numbers `stride` apart.
void running_sums(const float* from, float* to, int count, std::size_t stride, int reach) {
  double sum = 0;
  for (int i = 0; i < std::min(reach, count); ++i) sum += from[i * stride];
  for (int i = 0; i < count; ++i) {
    if (i + reach < count) sum += from[(i + reach) * stride];
    if (i - reach - 1 >= 0) sum -= from[(i - reach - 1) * stride];
    to[i * stride] = static_cast<float>(sum);
  }
}

void box_sums(std::vector<float>& values, int width, int height, int reach) {
  std::vector<float> across(values.size());
  for (int y = 0; y < height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * width;
    running_sums(&values[row], &across[row], width, 1, reach);
  }
  for (int x = 0; x < width; ++x) running_sums(&across[x], &values[x], height, width, reach);
}

}  // namespace

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      depth_(static_cast<std::size_t>(width) * height, kNothing),
      light_(depth_.size()),
      colour_(depth_.size()) {}

Canvas::Span Canvas::columns(double middle, double radius) const {
  return {static_cast<int>(std::clamp(std::ceil(middle - radius - 0.5), 0.0, 1.0 * width_)),
          static_cast<int>(std::clamp(std::floor(middle + radius + 0.5), 0.0, 1.0 * width_))};
}

Canvas::Span Canvas::rows(double middle, double radius) const {
  return {static_cast<int>(std::clamp(std::ceil(middle - radius - 0.5), 0.0, 1.0 * height_)),
          static_cast<int>(std::clamp(std::floor(middle + radius + 0.5), 0.0, 1.0 * height_))};
}

void Canvas::put(std::size_t pixel, float depth, const Vec3& normal, std::uint32_t colour) {
  if (!(depth > depth_[pixel])) return;
  depth_[pixel] = depth;
  light_[pixel] = lit(normal);
  colour_[pixel] = colour;
}

bool Canvas::covered(std::size_t pixel) const { return depth_[pixel] != kNothing; }

void Canvas::ball(const Camera& camera, const Vec3& centre, double radius, std::uint32_t colour) {
  const Vec3 c = camera.project(centre);
  const double r = std::max(0.75, radius * camera.scale);
  const auto [left, right] = columns(c.x(), r);
  const auto [top, bottom] = rows(c.y(), r);
  for (int y = top; y < bottom; ++y) {
    const double dy = y + 0.5 - c.y();
    for (int x = left; x < right; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width_ + x;
      const double dx = x + 0.5 - c.x(), rise = r * r - dx * dx - dy * dy;
      if (rise <= 0 || c.z() + r <= depth_[pixel]) continue;
      const double h = std::sqrt(rise);
      put(pixel, static_cast<float>(c.z() + h), Vec3(dx, -dy, h) / r, colour);
    }
  }
}

void Canvas::solid(const Camera& camera, const Pose& pose, double bounding_radius, const std::vector<SolidPart>& parts,
                   std::uint32_t colour) {
  const Vec3 c = camera.project(pose.position);
  const Quat inverse = pose.orientation.conjugate();
  const Vec3 right = inverse * camera.right, up = inverse * camera.up, toward = inverse * camera.toward;
  const double reach = std::max(0.75, bounding_radius * camera.scale);
  const auto [first, last] = columns(c.x(), reach);
  const auto [top, bottom] = rows(c.y(), reach);
  for (int y = top; y < bottom; ++y) {
    for (int x = first; x < last; ++x) {
      const double dx = (x + 0.5 - c.x()) / camera.scale, dy = (c.y() - y - 0.5) / camera.scale;
      const auto met = hit(parts, dx * right + dy * up + bounding_radius * toward, -toward);
      if (!met) continue;
      const double depth = c.z() + (bounding_radius - met->distance) * camera.scale;
      put(static_cast<std::size_t>(y) * width_ + x, static_cast<float>(depth),
          camera.turn(pose.orientation * met->normal), colour);
    }
  }
}

std::vector<float> Canvas::mean_depth(int reach) const {
  std::vector<float> sum(depth_.size()), count(depth_.size());
  for (std::size_t i = 0; i < depth_.size(); ++i) {
    sum[i] = covered(i) ? depth_[i] : 0;
    count[i] = covered(i) ? 1 : 0;
  }
  box_sums(sum, width_, height_, reach);
  box_sums(count, width_, height_, reach);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= std::max(1.0f, count[i]);
  return sum;
}

Image Canvas::shaded(int reach) const {
  const std::vector<float> mean = mean_depth(reach);
  Image image(width_, height_);
  for (std::size_t i = 0; i < depth_.size(); ++i) {
    if (!covered(i)) continue;
    const double sunk = std::clamp((mean[i] - depth_[i]) / (1.5 * reach), -0.25, 1.0);
    image.pixels[i] = scaled(palette(colour_[i]), light_[i] * (1 - 0.5 * sunk));
  }
  return image;
}

void Canvas::lines(Image& image, const Camera& camera, const std::vector<Edge>& edges, double front,
                   double hidden) const {
  for (const auto& [from, to] : edges) {
    const Vec3 a = camera.project(from), step = camera.project(to) - a;
    const int steps = static_cast<int>(std::min(1e5, std::ceil(step.head<2>().cwiseAbs().maxCoeff())));
    const bool steep = std::abs(step.y()) > std::abs(step.x());
    for (int k = 0; k <= 2 * steps + 1; ++k) {
      const Vec3 p = a + step * (steps ? 1.0 * (k / 2) / steps : 0.0);
      const int x = static_cast<int>(std::floor(p.x())) + (steep ? k % 2 : 0);
      const int y = static_cast<int>(std::floor(p.y())) + (steep ? 0 : k % 2);
      if (!image.contains(x, y)) continue;
      blend(image.at(x, y), p.z() >= depth_[static_cast<std::size_t>(y) * width_ + x] ? front : hidden);
    }
  }
}

Image halved(const Image& image) {
  Image half(image.width / 2, image.height / 2);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      for (int k = 0; k < 3; ++k) {
        const int sum = image.at(2 * x, 2 * y)[k] + image.at(2 * x + 1, 2 * y)[k] + image.at(2 * x, 2 * y + 1)[k] +
                        image.at(2 * x + 1, 2 * y + 1)[k];
        half.at(x, y)[k] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return half;
}

}  // namespace moraine
