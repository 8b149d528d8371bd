// SPDX-License-Identifier: Apache-2.0
// The same scene from micrometres to a thousand kilometres, and far from the origin: the same dimensionless answer.
#include "tests/extremes/outcome.hpp"

namespace moraine::test {
namespace {

/// Spheres of radius s fall into a box, with friction and bonds; times by the square root of s.
const std::string pile =
    "parameters: {s: 1, x: 0, y: 0, n: 60}\n"
    "gravity: [0, 0, -10]\nmaterials: {ball: {density: 2500, restitution: 0.2, friction: 0.4}}\n"
    "elements: [{packing: list, shape: {sphere: s}, items: [{id: 1, at: ['x + s', y, '1.0 * s']}, {id: 2, at: ['x + "
    "s', "
    "'y + 2.03 * s', '1.2 * s']}, {id: 3, at: ['x + 2.6 * s', 'y + s', '2.9 * s'], velocity: ['sqrt(s)', 0, 0]}, {id: "
    "4, "
    "at: ['x + 0.9 * s', 'y + 1.1 * s', '5 * s']}]}]\n"
    "boundaries: [{box: [['x - s', 'y - s', 0], ['x + 4 * s', 'y + 4 * s', '20 * s']]}]\n"
    "bonds: [{a: 1, b: 2, stiffness: '1e5 * 2500 * s^2'}]\n"
    "time: {dt: '0.01 * sqrt(s)', steps: n, substeps: 2}\nrun: {sub_models: 1}\n";

std::vector<Override> settings(const std::string& engine, double scale, double x, double y) {
  std::vector<Override> o = {set("run.engine", engine), set("s", scale), set("x", x), set("y", y)};
  if (engine == "soft_sphere") {
    o.push_back(set("time.substeps", 60));
    o.push_back(set("materials.ball.normal_stiffness", 1e4 * 2500 * 10 * 4 * scale * scale));
  }
  return o;
}

/// Largest difference of positions, in radii.
double difference(const Outcome& a, const Outcome& b, double scale, const Vec3& offset) {
  double most = 0;
  for (std::size_t i = 0; i < a.states.size(); ++i)
    most = std::max(most, ((b.position(i) - offset) / scale - a.position(i)).norm());
  return most;
}

/// How well the answer is known at a distance [radii]. Bullet and impulse work around a local origin: measured 6e-9.
/// soft_sphere works in doubles of the world: at 1e7 radii a place is known to 1e-9, so an overlap of 1e-4 to 1e-5 of
/// itself. Measured: 6e-8 at 1e4 radii, 3.2e-5 at 1e7, 1.0e-4 at 2e7.
double resolved(const std::string& engine, double distance) {
  return engine == "soft_sphere" ? std::max(1e-5, 1e-11 * distance) : 1e-5;
}

class Scale : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(Scale, OfLengthDoesNotMatter) {
  const auto [engine, power] = GetParam();
  const double s = std::pow(10.0, power);
  const Outcome one = attempt(pile, settings(engine, 1, 0, 0)), other = attempt(pile, settings(engine, s, 0, 0));
  ASSERT_TRUE(one.ran() && other.ran()) << one.text << other.text;
  const double d = difference(one, other, s, Vec3::Zero());
  record("X5 size", engine, fmt::format("r = 1e{} m", power), other.ending(), fmt::format("differs by {:.1e} r", d));
  EXPECT_LT(d, 1e-5);
  EXPECT_EQ(one.warnings.size(), other.warnings.size());
}

TEST_P(Scale, OfDistanceDoesNotMatter) {
  const auto [engine, power] = GetParam();
  if (power < 0) return;
  const double far = 10 * std::pow(10.0, power);  // up to 1e7 radii
  const Outcome one = attempt(pile, settings(engine, 1, 0, 0));
  const Outcome other = attempt(pile, settings(engine, 1, far, -far));
  ASSERT_TRUE(one.ran() && other.ran()) << one.text << other.text;
  const double d = difference(one, other, 1, Vec3(far, -far, 0));
  record("X6 distance", engine, fmt::format("1e{} radii of 1 m", power + 1), other.ending(),
         fmt::format("differs by {:.1e} r", d));
  EXPECT_LT(d, resolved(engine, far));
}

INSTANTIATE_TEST_SUITE_P(All, Scale, testing::Combine(testing::ValuesIn(all_engines), testing::Values(-6, -3, 3, 6)),
                         ByEngine{});

/// All at once, as far as doubles reach: 1e7 diameters away.
TEST(Far, TenMillionDiametersAway) {
  for (const std::string& engine : all_engines)
    for (const double s : {1e-6, 1.0, 1e6}) {
      const double far = 2e7 * s;
      const Outcome one = attempt(pile, settings(engine, 1, 0, 0));
      const Outcome other = attempt(pile, settings(engine, s, far, -far));
      ASSERT_TRUE(one.ran() && other.ran()) << one.text << other.text;
      const double d = difference(one, other, s, Vec3(far, -far, 0));
      record("X6 distance", engine, fmt::format("2e7 radii of {:.0e} m", s), other.ending(),
             fmt::format("differs by {:.1e} r", d));
      EXPECT_LT(d, resolved(engine, 2e7)) << engine << " " << s;
    }
}

}  // namespace
}  // namespace moraine::test
