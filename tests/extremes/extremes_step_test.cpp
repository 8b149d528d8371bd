// SPDX-License-Identifier: Apache-2.0
// Steps from far too short to far too long, and speeds at which elements could jump over others.
#include "tests/extremes/outcome.hpp"

namespace moraine::test {
namespace {

const double factors[] = {0.1, 0.316, 1, 3.16, 10, 31.6, 100};
constexpr const char* too_long = "is too long for engine soft_sphere: the limit is";

/// 27 spheres of 1 m fall into a box with a lid.
const std::string box_of_balls =
    "materials: {ball: {density: 1000, restitution: 0.3, friction: 0.3}}\n"
    "elements: [{packing: cubic, shape: {sphere: 0.5}, cells: [3, 3, 3], at: [0.2, 0.2, 0.6], spacing: 1.1, jitter: "
    "0.04}]\nboundaries: [{box: [[0, 0, 0], [3.7, 3.7, 5]]}]\ntime: {dt: 1, steps: 1}\nrun: {sub_models: 1}\n";

bool all_inside(const Outcome& o) {
  return std::all_of(o.states.begin(), o.states.end(), [](const ElementState& s) {
    const Vec3& x = s.pose.position;
    return (x.array() > 0).all() && x.x() < 3.7 && x.y() < 3.7 && x.z() < 5;
  });
}

class Step : public testing::TestWithParam<std::tuple<std::string, double>> {};

/// The step in parts of what the engine takes or resolves well. Beyond that it refuses, warns or stops.
TEST_P(Step, TooLongIsNeverSilent) {
  const auto [engine, factor] = GetParam();
  const Scene scene = scene_of(box_of_balls);
  const Engine& row = find_engine(engine);
  const double h = factor * std::min(row.step_limit(scene).substep, row.advised_step(scene).substep);
  const Outcome o = attempt(box_of_balls, {set("run.engine", engine), set("time.dt", h),
                                           set("time.steps", std::min(20000.0, std::max(100.0, std::ceil(2 / h))))});
  record("X3 step", engine, fmt::format("{:.3g} of its own", factor), o.ending(),
         o.ran() ? fmt::format("overlap {:.2g}, energy gained {:.1e} of what was dissipated", o.overlaps.max,
                               o.statistics.energy.gained / std::max(1.0, o.statistics.energy.dissipated))
                 : o.text.substr(o.text.find(": ") + 2));
  expect_no_silent_gain(o);
  if (!o.ran()) {
    EXPECT_GT(factor, 1) << o.text;
    EXPECT_TRUE(o.says(engine == "soft_sphere" ? too_long : "escape: ")) << o.text;
    return;
  }
  if (factor <= 1) {
    EXPECT_TRUE(o.warnings.empty()) << o.warnings.front();
    EXPECT_LT(o.overlaps.max, 0.05);
  }
  if (factor > 2) {
    EXPECT_FALSE(o.warnings.empty());
  }
  EXPECT_TRUE(all_inside(o));
}

INSTANTIATE_TEST_SUITE_P(All, Step, testing::Combine(testing::ValuesIn(all_engines), testing::ValuesIn(factors)),
                         ByEngine{});

struct Target {
  const char* name;
  const char* text;
  double thickness;  ///< way in a substep at which a ball of 1 m jumps over it [m]
};
void PrintTo(const Target& t, std::ostream* out) { *out << t.name; }

const Target targets[] = {
    {"plate", "boundaries: [{plate: {size: [0.5, 9, 9], at: [5.25, 0, 0]}}]\n", 1.5},
    {"sheet", "boundaries: [{mesh: {vertices: [[5, -9, -9], [5, 9, -9], [5, 0, 9]], triangles: [[0, 1, 2]]}}]\n", 1},
    {"plane", "boundaries: [{plane: {point: [5, 0, 0], normal: [-1, 0, 0]}}]\n", 1},
    {"ball", "", 2},
};

class Bullets : public testing::TestWithParam<std::tuple<std::string, Target, double>> {};

/// A ball flies at something. It comes back, or it was said that it could pass through.
TEST_P(Bullets, NeverPassSilently) {
  const auto [engine, target, ratio] = GetParam();
  const double h = 0.01, speed = ratio * target.thickness / h;
  const bool ball = std::string(target.name) == "ball";
  const std::string scene = fmt::format(
      "gravity: [0, 0, 0]\nmaterials: {{ball: {{density: 1, restitution: 1}}}}\n"
      "elements: [{{packing: list, shape: {{sphere: 0.5}}, mass: 1, items: [{{id: 1, at: [0.13, 0, 0], velocity: "
      "[{:.17g}, "
      "0, 0]}}{}]}}]\n{}time: {{dt: {}, steps: {}}}\nrun: {{sub_models: 1, engine: {}}}\n",
      speed, ball ? ", {id: 2, at: [5.5, 0, 0]}" : "", target.text, h, std::ceil(10 / (speed * h)) + 1, engine);
  const Outcome o = attempt(scene, {});
  const bool bounced = o.ran() && (ball ? o.velocity(1).x() > 0.5 * speed : o.velocity(0).x() < 0);
  record(fmt::format("X4 speed, {}", target.name), engine, fmt::format("{} of what jumps over it", ratio), o.ending(),
         o.ran() ? (bounced ? fmt::format("bounced, {:.3f} of its energy left",
                                          o.statistics.energy.kinetic / (0.5 * speed * speed))
                            : "passed through")
                 : o.text.substr(o.text.find(": ") + 2));
  expect_end(o, engine != "soft_sphere", too_long);
  if (!o.ran()) return;
  EXPECT_LT(o.statistics.energy.kinetic, 0.505 * speed * speed);
  if (!bounced) {
    EXPECT_TRUE(o.warned("tunnelling: "));
  }
  if (ratio <= 0.1) {
    EXPECT_TRUE(bounced);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Bullets,
                         testing::Combine(testing::ValuesIn(all_engines), testing::ValuesIn(targets),
                                          testing::Values(0.1, 0.5, 1, 3, 10)),
                         ByEngine{});

}  // namespace
}  // namespace moraine::test
