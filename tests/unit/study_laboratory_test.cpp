// SPDX-License-Identifier: Apache-2.0
// What a study does if its scene changes while it runs.
#include <gtest/gtest.h>

#include "physics/errors.hpp"
#include "study/laboratory.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine::study {
namespace {

const char* const scene = R"(
materials: {ball: {density: 1000}}
elements: [{packing: list, shape: {sphere: 0.5}, items: [{at: [0, 0, 0]}]}]
time: {dt: 0.01, steps: 1}
)";

/// A program that changes the scene, as somebody may who edits it, before it runs it.
TEST(Laboratory, RunsOfAChangedSceneDoNotCount) {
  const Folder folder;
  const std::filesystem::path file = folder.write("scene.yaml", scene);
  const std::filesystem::path program = folder.write(
      "program", "#!/bin/sh\nsed -i s/1000/2000/ " + file.string() + "\nexec " MORAINE_COMMAND " \"$@\"\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const Subject subject(file.string(), {},
                        [](const Scene& s) { return std::to_string(s.materials.materials.at(0).density); });
  const Setting setting = subject.resolve(Choices{{"engine", "impulse", "the test"}});
  Laboratory laboratory({.program = program, .folder = file.parent_path() / "out", .quiet = true});
  const std::vector<Trial> trials{{&setting, 1}};
  EXPECT_THROW(laboratory.run(subject, trials), InputError);
  const std::filesystem::path runs = file.parent_path() / "out" / "runs";
  for (const auto& entry : std::filesystem::directory_iterator(runs)) EXPECT_NE(entry.path().extension(), ".json");
}

}  // namespace
}  // namespace moraine::study
