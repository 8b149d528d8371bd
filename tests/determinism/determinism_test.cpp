// SPDX-License-Identifier: Apache-2.0
// What is computed never depends on where or in what order it runs.
#include <gtest/gtest.h>

#include "runtime/schedule/registry.hpp"
#include "tests/support/each_engine.hpp"

namespace moraine {
namespace {

using test::example;
using test::ModelRun;
using test::set;

/// Examples cut down to what takes a fraction of a second.
struct Case {
  std::string name, scene;
  std::vector<Override> overrides;
};

const std::vector<Case> examples = {
    {"crust_small",
     "crust_small",
     {set("count", 800), set("radius", "3000"), set("dt", 1), set("steps", 40), set("run.sub_models", 6)}},
    {"dam", "dam", {set("count", 1000), set("time.duration", 0.8), set("run.sub_models", 5), set("run.split", "rcb")}},
    {"mixed_shapes", "mixed_shapes", {set("count", 120), set("time.duration", 1.5)}},
    {"bonded_beam", "bonded_beam", {set("time.duration", 0.2)}},
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class SameHash : public testing::TestWithParam<Case> {
 protected:
  static Scene scene() { return example(GetParam().scene, GetParam().overrides); }
  static std::uint64_t hash(int threads, const std::string& scheduler) {
    return ModelRun(scene(), threads, scheduler).go().hash();
  }
};

TEST_P(SameHash, ForEverySchedulerAndNumberOfThreads) {
  const std::uint64_t alone = hash(1, "serial");
  for (const runtime::SchedulerRow& row : runtime::schedulers())
    for (const int threads : {1, 2, 3, 8})
      EXPECT_EQ(hash(threads, std::string(row.name)), alone) << row.name << " on " << threads;
}

TEST_P(SameHash, RunTwice) { EXPECT_EQ(hash(2, "hybrid"), hash(2, "hybrid")); }

TEST_P(SameHash, ButNotOneStepMore) {
  ModelRun run(scene());
  run.go();
  const std::uint64_t before = run.hash();
  run.steps(1);
  EXPECT_NE(run.hash(), before);
}

/// Stopping to look, as frames and progress do, changes nothing either.
TEST_P(SameHash, HoweverOftenTheRunStops) {
  ModelRun whole(scene()), stopping(scene());
  const std::int64_t steps = whole.scene().time.steps;
  whole.steps(steps);
  for (std::int64_t k = 0; k < steps; k += 7) stopping.steps(std::min<std::int64_t>(7, steps - k));
  EXPECT_EQ(whole.hash(), stopping.hash());
}

INSTANTIATE_TEST_SUITE_P(Examples, SameHash, testing::ValuesIn(test::with_every_engine(examples, 5)),
                         [](const auto& test) { return test.param.name; });

TEST(SameHashEver, InWhateverOrderElementsAreListed) {
  const std::string head =
      "materials: {rock: {density: 1000, friction: 0.5}}\nboundaries: [{plane: {point: [0, 0, 0], normal: [0, 0, "
      "1]}}]\n"
      "time: {dt: 0.005, steps: 200}\nrun: {sub_models: 2, split: slabs}\n"
      "elements:\n  - packing: list\n    shape: {sphere: 0.5}\n    items:\n";
  std::vector<std::string> items;
  for (int k = 0; k < 12; ++k)
    items.push_back(
        fmt::format("      - {{id: {}, at: [{}, {}, {}]}}\n", 10 + k, 0.55 * (k % 5), 0.1 * k, 0.6 + 1.01 * (k / 3)));
  const auto text = [&] {
    std::string all = head;
    for (const std::string& item : items) all += item;
    return all;
  };
  const std::uint64_t plain = ModelRun(scene_of(text())).go().hash();
  std::reverse(items.begin(), items.end());
  EXPECT_EQ(ModelRun(scene_of(text())).go().hash(), plain);
  std::rotate(items.begin(), items.begin() + 5, items.end());
  EXPECT_EQ(ModelRun(scene_of(text())).go().hash(), plain);
}

}  // namespace
}  // namespace moraine
