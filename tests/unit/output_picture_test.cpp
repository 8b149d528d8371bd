// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "output/picture.hpp"
#include "output/picture/font.hpp"
#include "output/picture/palette.hpp"
#include "output/picture/png.hpp"
#include "output/picture/solid.hpp"
#include "output_sample.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

/// Pixels of one half of the picture (0 upper, 1 lower) whose channels stand in the same proportion as the colour's.
int count_hue(const Image& image, int half, const Rgb& colour) {
  const double length = std::hypot(colour[0], colour[1], colour[2]);
  const auto like = [&](const Rgb& p) {
    const double size = std::hypot(p[0], p[1], p[2]);
    if (size < 60 || size > 400) return false;
    return (p[0] * colour[0] + p[1] * colour[1] + p[2] * colour[2]) / (size * length) > 0.9995;
  };
  const auto middle = image.pixels.begin() + static_cast<std::ptrdiff_t>(image.pixels.size() / 2);
  return static_cast<int>(half == 0 ? std::count_if(image.pixels.begin(), middle, like)
                                    : std::count_if(middle, image.pixels.end(), like));
}

TEST(Picture, ShowsElementsAboveAndGhostsBelow) {
  const Scene scene = sample::scene();
  Frame frame = sample::frame(scene);
  std::fill(frame.elements.sub_model.begin(), frame.elements.sub_model.end(), 0);
  std::fill(frame.ghosts.sub_model.begin(), frame.ghosts.sub_model.end(), 1);
  const Image image = draw_picture(scene, frame, 600);
  EXPECT_EQ(image.width, 600);
  EXPECT_GT(count_hue(image, 0, palette(0)), 500);
  EXPECT_EQ(count_hue(image, 0, palette(1)), 0);
  EXPECT_GT(count_hue(image, 1, palette(1)), 100);
  EXPECT_EQ(image.at(0, 0), (Rgb{255, 255, 255}));
}

TEST(Picture, IsTheSameEveryTimeAndSurvivesPng) {
  const sample::Folder folder("picture");
  const Scene scene = sample::scene();
  const Frame frame = sample::frame(scene);
  write_picture(scene, frame, folder / "a.png", 400);
  write_picture(scene, frame, folder / "b.png", 400);
  const Image a = read_png(folder / "a.png"), b = read_png(folder / "b.png");
  EXPECT_TRUE(a.pixels == b.pixels);
  EXPECT_TRUE(a.pixels == draw_picture(scene, frame, 400).pixels);
}

TEST(Picture, TakesWhateverAFrameHolds) {
  Scene scene = sample::scene();
  Frame frame = sample::frame(scene);
  frame.elements.state[3].pose.position.setConstant(std::numeric_limits<double>::quiet_NaN());
  frame.elements.state[4].pose.position.x() = 1e30;
  EXPECT_NO_THROW(draw_picture(scene, frame, 200));
  EXPECT_NO_THROW(draw_picture(scene, Frame{}, 200));
  scene.gravity.setZero();
  EXPECT_NO_THROW(draw_picture(scene, frame, 1));
}

TEST(Picture, NamesThePathItCannotWrite) {
  const Scene scene = sample::scene();
  EXPECT_THROW(write_picture(scene, sample::frame(scene), "/nowhere/a.png", 200), IoError);
}

TEST(Solid, RaysMeetTheSurface) {
  const Vec3 down = -Vec3::UnitZ();
  const auto top = [&](const Geometry& g, double x) { return hit(solid_parts(g), Vec3(x, 0, 10), down); };
  EXPECT_NEAR(top(Sphere{2}, 0)->distance, 8, 1e-12);
  EXPECT_FALSE(top(Sphere{2}, 2.1));
  EXPECT_NEAR(top(Cuboid{Vec3(1, 2, 3)}, 0.9)->distance, 7, 1e-12);
  EXPECT_FALSE(top(Cuboid{Vec3(1, 2, 3)}, 1.1));
  EXPECT_NEAR(top(Capsule{0.5, 2}, 0)->distance, 7.5, 1e-12);
  EXPECT_NEAR(hit(solid_parts(Capsule{0.5, 2}), Vec3(10, 0, 1), -Vec3::UnitX())->distance, 9.5, 1e-12);
  const ConvexHull octahedron{
      {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), -Vec3::UnitZ()}};
  EXPECT_NEAR(top(octahedron, 0.25)->distance, 9.25, 1e-12);
  EXPECT_NEAR(top(sample::compound(), 0.2)->distance, 9.8, 1e-12);
  EXPECT_FALSE(top(sample::compound(), 0.5));
}

TEST(Palette, SixtyColoursDiffer) {
  std::set<Rgb> colours;
  for (std::uint32_t i = 0; i < 60; ++i) colours.insert(palette(i));
  EXPECT_EQ(colours.size(), 60u);
}

TEST(Font, LettersDifferAndStayInside) {
  std::set<std::vector<Rgb>> letters;
  for (char c = ' '; c <= '~'; ++c) {
    Image image(6, 8);
    draw_text(image, 0, 0, std::string(1, c), 1, {0, 0, 0});
    letters.insert(image.pixels);
  }
  EXPECT_EQ(letters.size(), 95u);
  Image small(4, 4);
  draw_text(small, -3, 2, "\xff outside", 3, {0, 0, 0});
}

}  // namespace
}  // namespace moraine
