// SPDX-License-Identifier: Apache-2.0
// What every engine in the table must do: the contract of World.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/engine_scenes.hpp"
#include "tests/support/example_engine.hpp"
#include "tests/support/model_run.hpp"
#include "tests/support/single_world.hpp"

namespace moraine {
namespace {

using test::balls;
using test::floor;
using test::pile_of;
using test::same_bits;
using test::set;
using test::SingleWorld;

/// Those of the table, and the example of docs/engines.md.
const std::vector<Engine>& rows() {
  static const std::vector<Engine> all = [] {
    std::vector<Engine> list(engines().begin(), engines().end());
    list.push_back(test::spring_engine());
    return list;
  }();
  return all;
}

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const Engine& e : rows()) names.emplace_back(e.name);
  return names;
}

class EngineContract : public testing::TestWithParam<std::string> {
 protected:
  const Engine& engine() const {
    return *std::find_if(rows().begin(), rows().end(), [&](const Engine& e) { return e.name == GetParam(); });
  }
  std::string pile() const { return pile_of(engine()); }
};

/// Linear and angular momentum, the latter about the origin.
Impulse momentum(const SingleWorld& w) {
  Impulse sum;
  for (const Element& e : w.scene().elements) {
    const ElementState s = w.state(e.id);
    const Vec3 p = e.mass * s.twist.linear;
    sum += {p, s.pose.position.cross(p) + e.mass * w.scene().shape_of(e).inertia_per_mass.x() * s.twist.angular};
  }
  return sum;
}

/// An oblique impact of two spheres; the largest relative changes of momentum and of angular momentum.
std::pair<double, double> change_in_impact(const Engine& engine, double friction) {
  SingleWorld w(engine, scene_of(balls("{id: 1, at: [0, 0, 0], velocity: [2, 0.3, 0], angular_velocity: [0, 1, 2]}, "
                                       "{id: 2, at: [1.2, 0.3, 0.1], velocity: [-1, 0, 0], mass: 1700}",
                                       "", ", restitution: 0.6, friction: " + std::to_string(friction)),
                                 {set("gravity", "[0, 0, 0]")}));
  const Impulse before = momentum(w);
  w.steps(100);
  EXPECT_LT(w.velocity(1).x(), 1.5) << "they met";
  const Impulse after = momentum(w);
  return {(after.linear - before.linear).norm() / before.linear.norm(),
          (after.angular - before.angular).norm() / before.angular.norm()};
}

/// Angular momentum to float32's resolution of positions over 100 steps. Bullet: 4e-6.
TEST_P(EngineContract, FreeImpactKeepsMomentum) {
  const auto [linear, angular] = change_in_impact(engine(), 0);
  EXPECT_LT(linear, 1e-6);
  EXPECT_LT(angular, 1e-5);
}

/// Friction acts on either body at its own surface; where those overlap, angular momentum changes by the overlap times
/// the friction impulse. Overlaps are at most the way covered in a step: 1.5 % of a diameter here. Bullet: 1.8e-3.
TEST_P(EngineContract, ImpactWithFrictionKeepsMomentum) {
  const auto [linear, angular] = change_in_impact(engine(), 0.4);
  EXPECT_LT(linear, 1e-6);
  EXPECT_LT(angular, 3e-3);
}

/// z = z0 + v t - g t (t + h) / 2 by semi-implicit Euler, without the h if forces act in the middle of a substep.
TEST_P(EngineContract, FreeFallIsThatOfItsIntegrator) {
  SingleWorld w(engine(), scene_of(balls("{id: 1, at: [0, 0, 9], velocity: [1, 0, 2]}")));
  w.steps(100);
  const double h = (1 - 2 * engine().force_time) * w.substep(), t = 100 * w.step();
  EXPECT_NEAR(w.velocity(1).z(), 2 - 9.81 * t, 1e-5);
  EXPECT_NEAR(w.position(1).z(), 9 + 2 * t - 0.5 * 9.81 * t * (t + h), 1e-5);
  EXPECT_NEAR(w.position(1).x(), t, 1e-6);
}

TEST_P(EngineContract, OrderOfAddingDoesNotMatter) {
  SingleWorld plain(engine(), scene_of(pile()));
  plain.steps(50);
  for (unsigned seed = 1; seed < 4; ++seed) {
    std::vector<std::uint32_t> order(plain.scene().elements.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    SingleWorld other(engine(), scene_of(pile()), order);
    other.steps(50);
    for (const ElementId id : plain.ids()) EXPECT_TRUE(same_bits(plain.state(id), other.state(id))) << id;
  }
}

TEST_P(EngineContract, WhatWasRemovedLeavesNoTrace) {
  SingleWorld plain(engine(), scene_of(balls("{id: 1, at: [0, 0, 0.5]}, {id: 2, at: [0.1, 0, 1.6]}", floor)));
  SingleWorld other(engine(), scene_of(balls("{id: 1, at: [0, 0, 0.5]}, {id: 2, at: [0.1, 0, 1.6]}, "
                                             "{id: 3, at: [0, 0.2, 2.7]}",
                                             floor)));
  const ElementState first = other.state(1);
  other.world().remove(other.slot(1));
  other.world().remove(other.slot(3));
  const Element& e = other.scene().elements[0];
  const Slot reused = other.world().add({e.id, e.shape, e.material, e.mass, Role::real, first});
  plain.steps(60);
  other.steps(60);
  EXPECT_TRUE(same_bits(plain.state(1), other.world().state(reused)));
  EXPECT_TRUE(same_bits(plain.state(2), other.state(2)));
  EXPECT_EQ(other.world().work().bodies, 2U);
}

TEST_P(EngineContract, SavedWorldGoesOnAsTheOneThatStayed) {
  SingleWorld stays(engine(), scene_of(pile()));
  stays.steps(60);
  stays.world().canonicalise();
  ASSERT_GT(stays.world().work().contacts, 12U);
  std::vector<std::byte> image;
  stays.world().save(image);
  SingleWorld moved(engine(), stays);
  moved.world().load(image);
  for (int k = 0; k < 60; ++k) {
    for (const ElementId id : stays.ids())
      ASSERT_TRUE(same_bits(stays.state(id), moved.state(id))) << "element " << id << ", " << k << " steps later";
    stays.steps(1);
    moved.steps(1);
  }
}

TEST_P(EngineContract, DamagedImageIsRefused) {
  SingleWorld w(engine(), scene_of(pile()));
  w.steps(30);
  w.world().canonicalise();
  std::vector<std::byte> image;
  w.world().save(image);
  for (const std::size_t length : {std::size_t{0}, std::size_t{3}, image.size() / 2, image.size() - 1}) {
    SingleWorld other(engine(), w);
    EXPECT_THROW(other.world().load(std::span(image).first(length)), IoError) << length;
  }
  image[0] ^= std::byte{1};
  SingleWorld other(engine(), w);
  EXPECT_THROW(other.world().load(image), IoError);
}

TEST_P(EngineContract, FarElementsChangeNothing) {
  const std::string own = "{id: 5, at: [0, 0, 0.5]}, {id: 7, at: [0.2, 0.1, 1.55]}, {id: 9, at: [-0.9, 0.1, 0.8]}";
  const std::string far = ", {id: 1, at: [60, 0, 0.5], velocity: [3, 0, 0]}, {id: 8, at: [60, 30, 9]}";
  const std::string material = ", friction: 0.4, restitution: 0.3";
  SingleWorld alone(engine(), scene_of(balls(own + ", {id: 3, at: [-60, -1, 30]}", floor, material)));
  SingleWorld together(engine(), scene_of(balls(own + ", {id: 3, at: [-60, -1, 30]}" + far, floor, material)));
  alone.steps(100);
  together.steps(100);
  for (const ElementId id : {5U, 7U, 9U}) EXPECT_TRUE(same_bits(alone.state(id), together.state(id))) << id;
}

/// A state that is not a number stays where it is, to be found, and does nothing to elements that it does not touch.
TEST_P(EngineContract, NotANumberIsQuarantined) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const ElementState& bad : {ElementState{{Vec3(9, nan, 3), Quat::Identity()}, {}},
                                  ElementState{{Vec3(9, 0, 3), Quat::Identity()}, {Vec3(0, infinite, 0), {}}},
                                  ElementState{{Vec3(infinite, 0, 3), Quat::Identity()}, {}}})
    for (const std::string radius : {"0.5", "2"}) {  // as the others, and the only one of its size
      const std::string items =
          "{id: 1, at: [0, 0, 0.5]}, {id: 2, at: [0.2, 0.1, 1.55]}, {id: 3, at: [9, 0, 3], shape: {sphere: " + radius +
          "}}";
      SingleWorld sound(engine(), scene_of(balls(items, floor))), broken(engine(), scene_of(balls(items, floor)));
      sound.steps(3);
      broken.steps(3);
      broken.world().set_state(broken.slot(3), bad);
      sound.steps(20);
      broken.steps(20);
      EXPECT_FALSE(broken.position(3).allFinite() && broken.velocity(3).allFinite());
      for (const ElementId id : {1U, 2U}) EXPECT_TRUE(same_bits(sound.state(id), broken.state(id))) << id;
    }
}

/// A scene without friction, rotation, restitution and bonds goes as it would with all of them in use and zero. A push
/// through the centre may turn a ball by rounding: Bullet's by 1.3e-7 in float32, others' by 3e-16 at most.
TEST_P(EngineContract, WhatIsLeftOutChangesNothing) {
  const Scene scene =
      scene_of(balls("{id: 1, at: [0, 0, 0.6]}, {id: 2, at: [0.3, 0.1, 1.6]}, {id: 3, at: [0.9, 0, 0.7]}", floor));
  SingleWorld plain(engine(), scene), full(engine(), scene, {}, {}, Features{});
  ASSERT_FALSE(world_settings(scene).features.rotation);
  plain.steps(100);
  full.steps(100);
  for (const ElementId id : plain.ids()) {
    EXPECT_LT((plain.position(id) - full.position(id)).norm(), 1e-6) << id;
    EXPECT_LT(plain.state(id).pose.orientation.angularDistance(Quat::Identity()), 1e-6) << id;
  }
}

TEST_P(EngineContract, LimitsRefuse) {
  const Scene scene = scene_of(balls("{id: 1, at: [0, 0, 1]}, {id: 2, at: [2, 0, 1]}, {id: 3, at: [4, 0, 1]}", floor));
  Limits limits;
  limits.elements = 4;  // three elements and the floor
  EXPECT_NO_THROW(SingleWorld(engine(), scene, {}, limits));
  limits.elements = 3;
  try {
    SingleWorld(engine(), scene, {}, limits);
    FAIL() << "a world over its limit";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("the limit is 3"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(GetParam()), std::string::npos) << e.what();
  }
}

TEST_P(EngineContract, GhostsMeetRealElementsOnly) {
  const std::string items =
      "{id: 1, at: [0, 0, 0.6]}, {id: 2, at: [0, 0, 1.8]}, {id: 3, at: [5, 0, 0.6]}, {id: 4, at: [5, 0, 1.8]}";
  SingleWorld w(engine(), scene_of(balls(items, floor)));
  for (const ElementId id : {2U, 3U, 4U}) {
    w.world().remove(w.slot(id));
    w.add(w.scene().elements[id - 1], Role::ghost);
  }
  w.steps(200);
  EXPECT_NEAR(w.position(1).z(), 0.5, 0.01) << "real on the floor";
  EXPECT_NEAR(w.position(2).z(), 1.5, 0.02) << "ghost on a real one";
  EXPECT_NEAR(w.position(3).z(), 0.6 - 0.5 * 9.81, 0.03) << "ghost through the floor";
  EXPECT_NEAR(w.position(4).z() - w.position(3).z(), 1.2, 1e-3) << "ghost above a ghost";
}

TEST_P(EngineContract, MassIsWhatImpulsesFeelAndGravityDoesNot) {
  SingleWorld w(engine(), scene_of(balls("{id: 1, at: [0, 0, 0], mass: 8}, {id: 2, at: [5, 0, 0], mass: 8}")));
  w.world().set_mass(w.slot(1), 2, false);
  const Impulse push{Vec3(4, 0, 0), Vec3(0, 0, 0.1)};
  for (const ElementId id : {1U, 2U}) w.world().apply_impulse(w.slot(id), push);
  EXPECT_NEAR(w.velocity(1).x(), 2, 1e-5);
  EXPECT_NEAR(w.velocity(2).x(), 0.5, 1e-6);
  EXPECT_NEAR(w.state(1).twist.angular.z(), 0.1 / (0.4 * 2 * 0.25), 1e-5);
  EXPECT_NEAR(w.state(2).twist.angular.z(), 0.1 / (0.4 * 8 * 0.25), 1e-5);
  w.steps(100);
  EXPECT_NEAR(w.velocity(1).z(), -9.81 * 100 * w.step(), 1e-4);
  EXPECT_NEAR(w.velocity(2).z(), -9.81 * 100 * w.step(), 1e-4);
}

TEST_P(EngineContract, StateThatWasSetIsTheStateRead) {
  SingleWorld w(engine(), scene_of(balls("{id: 1, at: [0, 0, 0]}, {id: 2, at: [3, 0, 0]}")));
  ElementState s;
  s.pose.position = Vec3(1.25, -0.5, 2);
  s.pose.orientation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 2).normalized());
  s.twist = {Vec3(1, 2, 3), Vec3(-1, 0.5, 4)};
  w.world().set_state(w.slot(2), s);
  const ElementState back = w.state(2);
  EXPECT_LT((back.pose.position - s.pose.position).norm(), 1e-6);
  EXPECT_LT(back.pose.orientation.angularDistance(s.pose.orientation), 1e-3);
  EXPECT_LT((back.twist.linear - s.twist.linear).norm(), 1e-6);
  EXPECT_LT((back.twist.angular - s.twist.angular).norm(), 1e-6);
  std::vector<BodyMotion> motions;
  const std::vector<Slot> slots{w.slot(2), w.slot(1)};
  w.world().motions(slots, motions);
  EXPECT_EQ(motions.at(0).position, back.pose.position);
  EXPECT_EQ(motions.at(0).twist.angular, back.twist.angular);
  EXPECT_EQ(motions.at(1).position, w.position(1));
}

/// ODE takes overlaps back by a speed that stays: of the way per substep, by which the plate is in the ball when they
/// meet, the share `overlap_recovery`. Measured: all of it.
TEST_P(EngineContract, MovingBoundaryPushes) {
  SingleWorld w(engine(), scene_of(balls("{id: 1, at: [0, 0, 0], mass: 3}",
                                         "boundaries: [{plate: {size: [1, 4, 4], at: [-1.2, 0, 0]}, kinematic: true, "
                                         "motion: {velocity: [2, 0, 0], stop: 0.5}}]\n"),
                                   {set("gravity", "[0, 0, 0]")}));
  w.steps(80);
  const double kept = GetParam() == "ode" ? w.scene().run.overlap_recovery * 2 : 0;
  EXPECT_NEAR(w.velocity(1).x(), 2 + kept, 1e-3);
  EXPECT_NEAR(w.given().linear.x(), 3 * w.velocity(1).x(), 1e-4);
  EXPECT_NEAR(w.position(1).x(), -0.2 + 2 * 80 * w.step() + kept * (80 * w.step() - 0.15), 0.02)
      << "the plate's face has come this far";
}

/// ODE seeks every step's impulses from nothing: its 10 sweeps miss 1.2 % of the weight at most, 40 would miss 0.3 %.
TEST_P(EngineContract, ContactsCarryTheWeightAtRest) {
  SingleWorld w(engine(), scene_of(balls("{id: 1, at: [0, 0, 0.5], mass: 1}, {id: 2, at: [0, 0, 1.5], mass: 2}, "
                                         "{id: 3, at: [0, 0, 2.5], mass: 3}",
                                         floor)));
  w.steps(600);
  const double h = w.substep();
  const double missed = GetParam() == "ode" ? 0.012 : 1e-3;
  EXPECT_NEAR(w.world().boundary_impulse().linear.z(), 6 * 9.81 * h, missed * 6 * 9.81 * h);
  const std::vector<Contact> contacts = w.world().contacts();
  ASSERT_EQ(contacts.size(), 3U);
  for (const Contact& c : contacts) {
    const double above = c.with_boundary ? 6 : c.a == 1 ? 5 : 3;
    const double sign = c.with_boundary ? 1 : -1;  // on the lower one, except from the floor
    EXPECT_NEAR(c.impulse.z(), sign * above * 9.81 * h, 2 * missed * above * 9.81 * h) << c.a << " " << c.b;
    EXPECT_NEAR(c.normal.z(), sign, 1e-5);
    EXPECT_NEAR(c.overlap, 0, 0.02);
    EXPECT_NEAR(c.point.z(), c.with_boundary ? 0 : c.a, 0.02);
  }
  EXPECT_TRUE(std::is_sorted(contacts.begin(), contacts.end(), [](const Contact& p, const Contact& q) {
    return std::tuple(p.a, p.with_boundary, p.b) < std::tuple(q.a, q.with_boundary, q.b);
  }));
  std::vector<Contact> one_by_one;
  w.world().each_contact([&](const Contact& c) { one_by_one.push_back(c); });
  std::sort(one_by_one.begin(), one_by_one.end(), earlier);
  ASSERT_EQ(one_by_one.size(), contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) EXPECT_EQ(one_by_one[i].impulse, contacts[i].impulse);
}

TEST_P(EngineContract, BondBreaksOnceAndForGood) {
  if (!engine().bonds) GTEST_SKIP() << "has no bonds, and says so";
  SingleWorld w(engine(), scene_of(balls("{id: 1, at: [0, 0, 0], mass: 1}, {id: 2, at: [1.5, 0, 0], mass: 1, "
                                         "velocity: [4, 0, 0]}",
                                         "bonds: [{a: 1, b: 2, stiffness: 50, break_length: 1.1}]\n"),
                                   {set("gravity", "[0, 0, 0]")}));
  int broke = 0;
  double length_before = 0;
  for (int k = 0; k < 100 * w.substeps_per_step(); ++k) {
    const double length = (w.position(2) - w.position(1)).norm();
    w.substeps(1);
    if (w.world().broken_bonds().empty()) continue;
    ++broke;
    EXPECT_EQ(w.world().broken_bonds()[0], 0U);
    EXPECT_GT(length, 1.65);
    EXPECT_LT(length, 1.65 + 4 * w.substep());
    length_before = w.velocity(2).x();
  }
  EXPECT_EQ(broke, 1);
  EXPECT_EQ(w.world().work().bonds, 0U);
  EXPECT_EQ(w.velocity(2).x(), length_before) << "nothing holds it any more";
}

/// The scene at 1/1000 and 1000 times the size, times by the square root: the same motion.
TEST_P(EngineContract, ScaleDoesNotMatter) {
  SingleWorld one(engine(), scene_of(pile()));
  one.steps(60);
  for (const double scale : {1e-3, 1e3}) {
    SingleWorld other(engine(), scene_of(pile(), {set("s", scale)}));
    other.steps(60);
    for (const ElementId id : one.ids()) {
      EXPECT_LT((other.position(id) / scale - one.position(id)).norm(), 1e-5) << id << " at " << scale;
      EXPECT_LT((other.velocity(id) / std::sqrt(scale) - one.velocity(id)).norm(), 1e-4) << id << " at " << scale;
    }
  }
}

TEST_P(EngineContract, PlaceDoesNotMatter) {
  SingleWorld here(engine(), scene_of(pile()));
  here.steps(60);
  const Vec3 far(1e6, -1e6, 0);
  SingleWorld there(engine(), scene_of(pile(), {set("x", far.x()), set("y", far.y())}));
  there.steps(60);
  for (const ElementId id : here.ids()) {
    EXPECT_LT((there.position(id) - far - here.position(id)).norm(), 1e-5) << id;
    EXPECT_LT((there.velocity(id) - here.velocity(id)).norm(), 1e-4) << id;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EngineContract, testing::ValuesIn(engine_names()),
                         [](const auto& test) { return test.param; });

TEST(EngineTable, ListsItselfIfAskedForAnother) {
  try {
    find_engine("steam");
    FAIL();
  } catch (const InputError& e) {
    for (const Engine& row : engines()) EXPECT_NE(std::string(e.what()).find(row.name), std::string::npos) << row.name;
  }
}

}  // namespace
}  // namespace moraine
