// SPDX-License-Identifier: Apache-2.0
#include "output/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "output/label.hpp"
#include "output/picture/canvas.hpp"
#include "output/picture/font.hpp"
#include "output/picture/palette.hpp"
#include "output/picture/png.hpp"

namespace moraine {
namespace {

constexpr int kSamples = 2;  // per pixel and axis
constexpr Rgb kInk{50, 54, 62}, kPale{130, 134, 142};

/// From the share `low` to the share `1 - low` of an axis' values, stretched to all of them if they are not far.
std::pair<double, double> middle_range(std::vector<double> values) {
  const std::size_t cut = values.size() / 500;
  std::sort(values.begin(), values.end());
  const double low = values[cut], high = values[values.size() - 1 - cut], near = (high - low) / 4;
  return {std::max(values.front(), low - near), std::min(values.back(), high + near)};
}

/// Where nearly all bodies are: a few that fly away do not shrink the rest.
Bounds crowd(const Scene& scene, const Frame::Bodies& bodies) {
  Bounds box;
  double radius = 0;
  if (bodies.size() == 0) return {Vec3::Constant(-1), Vec3::Constant(1)};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const ElementState& s : bodies.state) values.push_back(s.pose.position[axis]);
    std::tie(box.min[axis], box.max[axis]) = middle_range(std::move(values));
  }
  for (std::uint32_t shape : bodies.shape) radius = std::max(radius, scene.shapes[shape].bounding_radius);
  return box.inflated(radius > 0 ? radius : 1);
}

/// The crowd with what of the boundaries is near it.
Bounds view_box(const Bounds& crowd, const std::vector<Edge>& edges) {
  const Bounds near = crowd.inflated(0.2 * (crowd.max - crowd.min).norm());
  Bounds box = crowd;
  for (const auto& [a, b] : edges) {
    box.add(a.cwiseMax(near.min).cwiseMin(near.max));
    box.add(b.cwiseMax(near.min).cwiseMin(near.max));
  }
  return box;
}

double mean_radius(const Scene& scene, const Frame::Bodies& bodies) {
  double sum = 0;
  for (std::uint32_t shape : bodies.shape) sum += scene.shapes[shape].bounding_radius;
  return bodies.size() ? sum / static_cast<double>(bodies.size()) : 0;
}

/// What both panels share.
struct Stage {
  const Scene& scene;
  std::vector<std::vector<SolidPart>> parts;  ///< per shape; empty for spheres
  Camera camera;
  int width, height;  ///< of a panel [samples]
  int reach;          ///< of corner darkening [samples]
};

Stage make_stage(const Scene& scene, const Frame& frame, const Bounds& box, int width) {
  Stage stage{scene, {}, {}, width * kSamples, 0, 0};
  for (const Shape& shape : scene.shapes) {
    stage.parts.push_back(shape.sphere() ? std::vector<SolidPart>{} : solid_parts(shape.geometry));
  }
  stage.camera = block_view(box, scene.gravity, stage.width, stage.width * 3 / 5, stage.width / 50);
  stage.height = 2 * static_cast<int>(std::ceil(stage.camera.middle_y));
  const double radius = mean_radius(scene, frame.elements) * stage.camera.scale;
  stage.reach = static_cast<int>(std::clamp(1.5 * radius, 3.0, stage.width / 40.0));
  return stage;
}

void draw_bodies(Canvas& canvas, const Stage& stage, const Frame::Bodies& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Shape& shape = stage.scene.shapes[bodies.shape[i]];
    const Pose& pose = bodies.state[i].pose;
    if (!pose.position.allFinite()) continue;
    if (shape.sphere()) {
      canvas.ball(stage.camera, pose.position, shape.bounding_radius, bodies.sub_model[i]);
    } else {
      canvas.solid(stage.camera, pose, shape.bounding_radius, stage.parts[bodies.shape[i]], bodies.sub_model[i]);
    }
  }
}

Image panel(const Stage& stage, const Frame::Bodies& bodies, const std::vector<Edge>& outline,
            const std::vector<Edge>& boundaries) {
  Canvas canvas(stage.width, stage.height);
  draw_bodies(canvas, stage, bodies);
  Image image = canvas.shaded(stage.reach);
  canvas.lines(image, stage.camera, outline, 0.3, 0.0);
  canvas.lines(image, stage.camera, boundaries, 0.85, 0.08);
  return halved(image);
}

void paste(Image& image, const Image& part, int top) {
  for (int y = 0; y < part.height; ++y) std::copy_n(&part.at(0, y), part.width, &image.at(0, top + y));
}

std::uint32_t sub_model_count(const Frame::Bodies& bodies) {
  return bodies.size() ? 1 + *std::max_element(bodies.sub_model.begin(), bodies.sub_model.end()) : 0;
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", grouped(count), what, count == 1 ? "" : "s");
}

std::string ghost_caption(const Frame& frame) {
  const double share = frame.elements.size() ? 100.0 * frame.ghosts.size() / frame.elements.size() : 0;
  return fmt::format("{} by host sub-model, {:.1f} % of the elements", counted(frame.ghosts.size(), "ghost"), share);
}

/// A row of numbered swatches, as many as fit.
void draw_legend(Image& image, int left, int top, std::uint32_t count, int size) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string number = fmt::format("{}", i);
    if (left + 10 * size + text_width(number, size) > image.width) return;
    for (int y = top; y < top + 7 * size; ++y) std::fill_n(&image.at(left, y), 7 * size, palette(i));
    draw_text(image, left + 9 * size, top, number, size, kPale);
    left += 13 * size + text_width(number, size);
  }
}

}  // namespace

Image draw_picture(const Scene& scene, const Frame& frame, int width) {
  const std::vector<Edge> boundaries = boundary_edges(scene, frame);
  const Bounds bodies = crowd(scene, frame.elements);
  const Stage stage = make_stage(scene, frame, view_box(bodies, boundaries), std::max(width, 200));
  const int size = std::max(1, stage.width / kSamples / 600), line = 12 * size, left = stage.width / kSamples / 50;
  const int panel_height = stage.height / kSamples;
  const std::uint32_t sub_models = sub_model_count(frame.elements);
  Image image(stage.width / kSamples, 2 * panel_height + 5 * line);
  draw_text(image, left, line / 2, scene.name, size, kInk);
  draw_text(image, left, line / 2 + line,
            fmt::format("step {}   {}   {} in {}", frame.step, time_label(scene.time, frame.step, frame.time),
                        counted(frame.elements.size(), "element"), counted(sub_models, "sub-model")),
            size, kPale);
  paste(image, panel(stage, frame.elements, {}, boundaries), 2 * line + line / 2);
  paste(image, panel(stage, frame.ghosts, box_edges(bodies), boundaries), panel_height + 4 * line - line / 2);
  draw_text(image, left, panel_height + 3 * line, ghost_caption(frame), size, kPale);
  draw_legend(image, left, image.height - line, sub_models, size);
  return image;
}

void write_picture(const Scene& scene, const Frame& frame, const std::filesystem::path& path, int width) {
  write_png(draw_picture(scene, frame, width), path);
}

}  // namespace moraine
