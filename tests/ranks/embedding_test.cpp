// SPDX-License-Identifier: Apache-2.0
// A host program with the runtime in it gives the same numbers alone and on ranks.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "tests/support/shell.hpp"

namespace moraine {
namespace {

/// Lines without the rank that says them, in order of pieces.
std::vector<std::string> pieces(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (const std::size_t at = line.find("piece "); at != std::string::npos) lines.push_back(line.substr(at));
  std::sort(lines.begin(), lines.end());
  return lines;
}

std::vector<std::string> rod(int ranks) {
  const test::Ended ended = test::shell(test::mpirun(ranks) + MORAINE_ROD);
  EXPECT_EQ(ended.status, 0) << ended.text;
  return pieces(ended.text);
}

TEST(Embedding, RodIsTheSameOnRanks) {
  const std::vector<std::string> alone = rod(0);
  ASSERT_EQ(alone.size(), 3);
  EXPECT_EQ(rod(2), alone);
  EXPECT_EQ(rod(3), alone);
}

}  // namespace
}  // namespace moraine
