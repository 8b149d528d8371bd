// SPDX-License-Identifier: Apache-2.0
// Sub-models together: what must hold between epochs, cutting again, bonds across cuts.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/run_error.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::example;
using test::ModelRun;
using test::set;

const std::vector<Override> small_dam{set("count", 400), set("time.duration", 1.5), set("time.substeps", 2)};

std::vector<Override> with(std::vector<Override> base, const std::vector<Override>& more) {
  base.insert(base.end(), more.begin(), more.end());
  return base;
}

/// Elements owned once, ghosts where their owners say, offsets that sum to nothing to the rounding of velocities.
void expect_invariants(const CoupledModel& model) {
  std::vector<int> owned(model.scene().elements.size(), 0);
  for (std::size_t p = 0; p < model.size(); ++p) {
    const SubModel& part = model.part(p);
    for (const std::uint32_t e : part.members()) {
      ++owned[e];
      EXPECT_EQ(model.owners()[e], p);
    }
    for (const HostLink& link : part.host_links())
      for (const Ghost& g : link.ghosts) {
        EXPECT_EQ(model.owners()[g.element], link.owner);
        const auto& owners = model.part(link.owner).owner_links();
        const bool known = std::any_of(owners.begin(), owners.end(), [&](const OwnerLink& l) { return l.host == p; });
        EXPECT_TRUE(known) << "the owner knows its host";
      }
    for (const SharedElement& s : part.shared()) {
      Twist sum;
      for (const Copy& c : s.copies) sum += c.share * c.offset;
      EXPECT_LT(sum.linear.norm(), 1e-13 * (10 + s.state.twist.linear.norm())) << "element " << s.element;
      EXPECT_LT(sum.angular.norm(), 1e-13 * (100 + s.state.twist.angular.norm())) << "element " << s.element;
    }
  }
  EXPECT_EQ(std::count(owned.begin(), owned.end(), 1), static_cast<std::ptrdiff_t>(owned.size()));
}

class Invariants : public testing::TestWithParam<std::string> {};

TEST_P(Invariants, HoldBetweenAllEpochs) {
  int epochs = 0;
  ModelRun run(example("dam", with(small_dam, {set("run.sub_models", 5), set("run.split", GetParam())})), 1, "serial",
               [&](const CoupledModel& model) {
                 ++epochs;
                 expect_invariants(model);
               });
  run.go();
  EXPECT_GE(epochs, 4);
  EXPECT_GT(run.model().statistics().ghosts_max, 10U);
  EXPECT_LT(run.model().statistics().linear_residual, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(All, Invariants, testing::Values("slabs", "rcb", "pillars", "curve"),
                         [](const auto& test) { return test.param; });

/// Spheres that start apart, without ghosts, fall together and need them.
TEST(Model, CutsAgainWhereGhostsHaveBecomeMany) {
  ModelRun run(example("dam", with(small_dam,
                                   {set("run.sub_models", 4), set("run.split", "slabs"),
                                    set("run.recut_ghost_share", 0.02), set("spacing", 1.3), set("time.duration", 3)})),
               1, "serial", expect_invariants);
  run.go();
  const ModelStatistics s = run.model().statistics();
  EXPECT_GE(s.recuts, 1U);
  EXPECT_LT(s.linear_residual, 1e-5);
  EXPECT_GT(s.ghosts_mean, 0);
  EXPECT_LE(s.ghosts_mean, static_cast<double>(s.ghosts_max));
  std::vector<std::size_t> count(4, 0);
  for (const SubModelId p : run.model().owners()) ++count.at(p);
  for (const std::size_t n : count) EXPECT_EQ(n, 100U);
}

TEST(Model, OneSubModelHasNoGhosts) {
  ModelRun run(example("dam", with(small_dam, {set("run.sub_models", 1), set("time.duration", 0.3)})));
  run.go();
  EXPECT_EQ(run.model().statistics().ghosts_max, 0U);
  EXPECT_EQ(run.model().statistics().coupling_residual, 0);
}

TEST(Model, MoreSubModelsThanElementsRun) {
  ModelRun run(example("two_spheres", {set("run.sub_models", 7), set("run.split", "rcb")}), 1, "serial",
               expect_invariants);
  run.go();
  EXPECT_EQ(run.model().size(), 7U);
  EXPECT_LT(run.velocity(1).x(), 0) << "they met and parted";
}

TEST(Model, NoElementsRun) {
  ModelRun run(scene_of("parameters: {a: 1}\ntime: {dt: 0.01, steps: 20}\nrun: {sub_models: 3}\n"));
  run.go();
  EXPECT_EQ(run.model().statistics().ledger.mass, 0);
  EXPECT_EQ(run.model().owners().size(), 0U);
}

/// Bonds across a cut break where the ghost is, are counted once, and let go in both sub-models.
TEST(Model, BondsAcrossACutBreakOnce) {
  const std::string text = R"(
parameters: {k: 20}
gravity: [0, 0, 0]
materials: {rock: {density: 1000}}
elements:
  - {packing: list, shape: {sphere: 0.5}, mass: 1, items: [{id: 1, at: [0, 0, 0]}, {id: 2, at: [1.2, 0, 0], velocity: [3, 0, 0]}]}
bonds: [{a: 1, b: 2, stiffness: k, break_length: 1.1}]
time: {dt: 0.01, steps: 60}
run: {split: slabs}
)";
  ModelRun whole(scene_of(text, {set("run.sub_models", 1)})), cut(scene_of(text, {set("run.sub_models", 2)}));
  whole.go();
  cut.go();
  EXPECT_EQ(whole.model().statistics().bonds_broken, 1U);
  EXPECT_EQ(cut.model().statistics().bonds_broken, 1U);
  EXPECT_TRUE(cut.model().alive_bonds().empty());
  EXPECT_EQ(cut.model().statistics().ghosts_now, 0U) << "nothing near, nothing bonded: no ghost";
  EXPECT_NEAR(cut.velocity(1).x(), whole.velocity(1).x(), 0.02);
  EXPECT_NEAR(cut.velocity(1).x() + cut.velocity(2).x(), 3, 1e-6);
}

TEST(Model, RunawayIsNoticed) {
  ModelRun run(example("two_spheres", {set("run.max_speed", 0.5)}));
  try {
    run.go();
    FAIL() << "faster than allowed";
  } catch (const runtime::RunError& e) {
    EXPECT_THROW(std::rethrow_exception(e.cause()), InvalidStateError);
  }
}

}  // namespace
}  // namespace moraine
