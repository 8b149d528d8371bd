// SPDX-License-Identifier: Apache-2.0
// A scene may state who owns what at first.
#include <gtest/gtest.h>

#include "ghosting/model.hpp"
#include "tests/support/engine_scenes.hpp"
#include "tests/support/rank_run.hpp"

namespace moraine {
namespace {

TEST(StatedOwners, AreThoseAtFirst) {
  const Scene scene =
      test::example("dam", {test::set("count", 60), test::set("run.sub_models", 5), test::set("run.owners", "[4, 1]")});
  test::on_ranks({.ranks = 2}, [&](runtime::Transport& transport) {
    EXPECT_EQ(CoupledModel(scene, transport).placement().owner, (runtime::Owners{0, 0, 0, 0, 1}));
  });
}

TEST(StatedOwners, HaveNothingToSayOnOneRank) {
  const Scene scene = test::example("dam", {test::set("count", 60), test::set("run.owners", "[4, 1]")});
  EXPECT_EQ(CoupledModel(scene).size(), CoupledModel(scene).placement().owner.size());
}

}  // namespace
}  // namespace moraine
