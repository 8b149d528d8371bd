// SPDX-License-Identifier: Apache-2.0
// Saving and reloading every sub-model in place, whenever that is allowed, must not change a bit.
#include <gtest/gtest.h>

#include "tests/support/each_engine.hpp"

namespace moraine {
namespace {

using test::example;
using test::set;

/// A model that puts each of its sub-models through its saved form.
class Reloading final : public CoupledModel {
 public:
  using CoupledModel::CoupledModel;

  runtime::EpochPlan begin_epoch(std::int64_t next_round, std::int64_t at_most) override {
    const runtime::EpochPlan plan = CoupledModel::begin_epoch(next_round, at_most);
    for (SubModelId id = 0; plan.fresh && id < size(); ++id) reload(id);
    return plan;
  }
  int reloads = 0;

 private:
  void reload(SubModelId id) {
    std::vector<std::byte> saved, again;
    sub_model(id).save(saved);
    release(id);
    adopt(id, saved);
    sub_model(id).save(again);
    EXPECT_EQ(saved, again) << "sub-model " << id;
    ++reloads;
  }
};

template <class Model>
std::uint64_t hash_after(const Scene& scene, Model& model) {
  runtime::Simulation(model, {.threads = 1, .scheduler = "serial"}).run(0, scene.time.steps * scene.time.substeps);
  return state_hash(scene, model.states());
}

struct ReloadCase {
  std::string name, scene;
  std::vector<Override> settings;
};
void PrintTo(const ReloadCase& c, std::ostream* out) { *out << c.name; }

class Reload : public testing::TestWithParam<ReloadCase> {};

TEST_P(Reload, ChangesNothing) {
  const Scene scene = example(GetParam().scene, GetParam().settings);
  CoupledModel plain(scene);
  Reloading reloaded(scene);
  EXPECT_EQ(hash_after(scene, reloaded), hash_after(scene, plain));
  EXPECT_GT(reloaded.reloads, 2 * static_cast<int>(scene.run.sub_models));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Reload,
    testing::ValuesIn(test::with_every_engine<ReloadCase>(
        {ReloadCase{
             "crust_small",
             "crust_small",
             {set("count", 800), set("radius", "3000"), set("dt", 1), set("steps", 100), set("run.sub_models", 4)}},
         ReloadCase{"mixed_shapes", "mixed_shapes", {set("time.duration", 1.5), set("run.sub_models", 4)}},
         ReloadCase{"bonded_beam", "bonded_beam", {set("time.duration", 0.5), set("run.sub_models", 3)}},
         ReloadCase{"beam_impulse",
                    "bonded_beam",
                    {set("time.duration", 0.5), set("run.sub_models", 3), set("run.engine", "impulse")}},
         ReloadCase{"column", "column", {set("time.duration", 1), set("run.sub_models", 5)}}},
        4)),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moraine
