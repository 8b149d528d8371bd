// SPDX-License-Identifier: Apache-2.0
// With the coupling `exact` a model's answer does not depend on how it is cut, nor on when it is cut anew.
#include <gtest/gtest.h>

#include "ghosting/check.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::example;
using test::ModelRun;
using test::set;

/// Two bonded, spinning blocks of unequal spheres run into each other between walls, one of which comes closer; bonds
/// break, contacts slide and roll, and the sub-models' elements mix until the model is cut anew.
const std::string clash = R"(
parameters: {seconds: 2.4}
gravity: [0, 0, -1]
materials: {rock: {density: 1000, friction: 0.5, restitution: 0.3, rolling_friction: 0.05}}
elements:
  - {packing: hcp, shape: {sphere: 0.5}, cells: [4, 4, 4], at: [0, 0, 0.01], jitter: 0.005, velocity: [2, 0, 0], angular_velocity: [0, 1, 3]}
  - {packing: cubic, shape: {sphere: 0.4}, cells: [4, 4, 5], at: [5, 0.3, 0.01], jitter: 0.005, velocity: [-2, 0.3, 0], seed: 3}
boundaries:
  - {box: [[-1, -1, 0], [10, 5, 9]], triangulated: true, open_top: true}
  - {plate: {size: [1, 6, 9], at: [9.5, 2, 4.5]}, kinematic: true, motion: {velocity: [-0.5, 0, 0], stop: 2, ramp: 0.2}}
bonds: {between: touching, tolerance: 0.02, stiffness: 1e5, damping: 50, break_length: {mean: 1.01, spread: 0.004, seed: 5}}
time: {dt: 4e-4, duration: seconds}
run: {engine: soft_sphere, recut_ghost_share: 0}
)";

struct Outcome {
  std::uint64_t hash = 0;
  std::size_t broken = 0, recuts = 0;
  double residual = 0;
};

Outcome outcome(Scene scene, int threads = 1) {
  ModelRun run(std::move(scene), threads, threads == 1 ? "serial" : "hybrid", verify_invariants);
  run.go();
  const ModelStatistics s = run.model().statistics();
  return {run.hash(), s.bonds_broken, s.recuts, std::max(s.linear_residual, s.angular_residual)};
}

Scene clash_in(int parts, const std::string& split) {
  return scene_of(clash, {set("run.sub_models", parts), set("run.split", split)});
}

TEST(ExactCoupling, GivesTheUncutAnswerHoweverTheModelIsCut) {
  const Outcome uncut = outcome(clash_in(1, "rcb"));
  EXPECT_GT(uncut.broken, 20U);
  std::size_t recuts = 0;
  for (const auto& [parts, split] : {std::pair{2, "slabs"}, {2, "rcb"}, {7, "curve"}, {7, "rcb"}, {64, "rcb"}}) {
    const Outcome cut = outcome(clash_in(parts, split));
    EXPECT_EQ(cut.hash, uncut.hash) << parts << " by " << split;
    EXPECT_EQ(cut.broken, uncut.broken) << parts << " by " << split;
    EXPECT_LT(cut.residual, 1e-10) << parts << " by " << split;
    recuts += cut.recuts;
  }
  EXPECT_GT(recuts, 0U) << "cutting anew was not tested";
}

TEST(ExactCoupling, GivesTheSameOnAnyNumberOfThreads) {
  const std::uint64_t alone = outcome(clash_in(7, "rcb")).hash;
  for (const int threads : {2, 8}) EXPECT_EQ(outcome(clash_in(7, "rcb"), threads).hash, alone) << threads;
}

/// A large ball falls into a heap of small ones, a twentieth of its size.
TEST(ExactCoupling, HoldsForUnequalSizes) {
  const auto heap = [](int parts) {
    return scene_of(R"(
materials: {rock: {density: 1000, friction: 0.4, restitution: 0.4}}
elements:
  - {packing: hcp, shape: {sphere: 0.05}, cells: [10, 10, 4], at: [0, 0, 0.01], jitter: 0.01}
  - {packing: list, shape: {sphere: 1}, items: [{at: [0.5, 0.5, 1.6], velocity: [0, 0, -3]}]}
boundaries: [{plane: {normal: [0, 0, 1]}}]
time: {dt: 1e-5, duration: 0.05}
run: {engine: soft_sphere, split: rcb}
)",
                    {set("run.sub_models", parts), set("materials.rock.normal_stiffness", 2e4)});
  };
  const Outcome uncut = outcome(heap(1)), cut = outcome(heap(6));
  EXPECT_EQ(cut.hash, uncut.hash);
  EXPECT_LT(cut.residual, 1e-10);
}

/// A collapsing dam with Hertz contacts.
TEST(ExactCoupling, HoldsForHertzContacts) {
  const auto dam = [](int parts) {
    return example("dam", {set("count", 400), set("run.engine", "soft_sphere"), set("run.sub_models", parts),
                           set("materials.grain.restitution", 0.5), set("materials.grain.young", "2e7"),
                           set("time.dt", 1e-4), set("time.duration", 0.15)});
  };
  EXPECT_EQ(outcome(dam(5)).hash, outcome(dam(1)).hash);
}

/// Saving every part and going on from the bytes in a new model is what migration does.
TEST(ExactCoupling, SurvivesBeingSavedAndLoaded) {
  ModelRun stays(clash_in(3, "rcb")), source(clash_in(3, "rcb"));
  stays.steps(3000);
  source.steps(3000);
  for (std::size_t p = 0; p < source.model().size(); ++p) {
    std::vector<std::byte> before, after;
    source.part(p).save(before);
    source.part(p).load(before);
    source.part(p).save(after);
    EXPECT_EQ(before, after) << "sub-model " << p;
  }
  stays.steps(1000);
  source.steps(1000);
  EXPECT_EQ(stays.hash(), source.hash());
}

TEST(ExactCoupling, IsTheOnlyOneThatFits) {
  EXPECT_EQ(find_coupling("auto", find_engine("soft_sphere")).name, "exact");
  EXPECT_EQ(find_coupling("auto", find_engine("bullet")).name, "consensus");
  for (const char* wrong : {"consensus", "mirror"})
    EXPECT_THROW(find_coupling(wrong, find_engine("soft_sphere")), InputError) << wrong;
  EXPECT_THROW(find_coupling("exact", find_engine("bullet")), InputError);
}

}  // namespace
}  // namespace moraine
