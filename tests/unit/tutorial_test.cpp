// SPDX-License-Identifier: Apache-2.0
// Every command of docs/tutorial.md, in its order, in an empty folder.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "tests/support/shell.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine {
namespace {

/// What stands between two lines of ```: a scene, or commands, of which one after "$ " has its output below it.
struct Block {
  std::string language;
  std::vector<std::string> lines;
};

std::vector<Block> blocks_of(std::istream& page) {
  std::vector<Block> blocks;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), {}});
    } else if (inside) {
      blocks.back().lines.push_back(line);
    }
  }
  return blocks;
}

std::string joined(const std::vector<std::string>& lines, std::size_t from = 0) {
  std::string text;
  for (std::size_t i = from; i < lines.size(); ++i) text += lines[i] + "\n";
  return text;
}

class Tutorial : public testing::Test {
 protected:
  Tutorial() {
    std::filesystem::create_directory(top_ / "build");
    std::filesystem::create_symlink(MORAINE_COMMAND, top_ / "build" / "moraine");
    std::filesystem::create_symlink(MORAINE_SOURCE_DIR "/apps", top_ / "apps");
  }

  test::Ended here(const std::string& line) { return test::shell("cd " + top_.string() + "; " + line); }

  /// A scene whose first line is "# NAME.yaml" is that file; others show a part of one.
  void write(const Block& scene) {
    const std::string& first = scene.lines.front();
    if (first.starts_with("# ")) folder_.write(first.substr(2), joined(scene.lines));
  }

  void run(const Block& commands) {
    const std::string& first = commands.lines.front();
    if (first.starts_with("$ ")) {
      EXPECT_EQ(here(first.substr(2)).text, joined(commands.lines, 1));
      return;
    }
    for (const std::string& line : commands.lines) {
      const test::Ended ended = here(line);
      EXPECT_EQ(ended.status, 0) << line << '\n' << ended.text;
    }
  }

  nlohmann::json summary(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(top_ / "out" / name / "summary.json"));
  }

  Folder folder_;
  std::filesystem::path top_ = folder_.write("build.txt", "").parent_path();
};

TEST_F(Tutorial, EveryCommandDoesWhatItSays) {
  std::ifstream page(MORAINE_SOURCE_DIR "/docs/tutorial.md");
  for (const Block& block : blocks_of(page)) {
    if (block.language == "yaml")
      write(block);
    else
      run(block);
  }
  const auto cut = summary("beam"), whole = summary("beam_whole");
  EXPECT_EQ(cut.at("state_hash"), summary("beam_serial").at("state_hash"));
  EXPECT_EQ(cut.at("bonds").at("broken"), 0);
  EXPECT_GT(summary("beam_weak").at("bonds").at("broken"), 0);
  EXPECT_NEAR(cut.at("center_of_mass")[2].get<double>(), whole.at("center_of_mass")[2].get<double>(), 0.002);
}

}  // namespace
}  // namespace moraine
