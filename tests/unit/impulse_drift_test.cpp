// SPDX-License-Identifier: Apache-2.0
// How far neighbours have come apart.
#include <gtest/gtest.h>

#include <random>

#include "physics/impulse/drift.hpp"

namespace moraine::impulse {
namespace {

constexpr float gap = 1.5F;

class ImpulseDrift : public testing::Test {
 protected:
  ImpulseDrift() {
    for (int i = 0; i < 800; ++i) at_.emplace_back(number(0, 30), number(-5, 5), number(0, 9), number(0.3F, 0.6F));
    drift_.list(at_, gap);
  }
  float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  /// All bodies, gone by way(place).
  template <class Way>
  std::vector<Vec> gone(Way way) {
    std::vector<Vec> now = at_;
    for (Vec& p : now) p += way(Vec(p));
    return now;
  }
  /// Largest difference between the ways of two bodies that were nearer than the gap.
  float largest(const std::vector<Vec>& now) const {
    float most = 0;
    for (std::size_t i = 0; i < at_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (three(at_[i] - at_[j]).norm() - at_[i].w() - at_[j].w() < gap)
          most = std::max(most, Vec(now[i] - at_[i] - now[j] + at_[j]).norm());
    return most;
  }

  std::mt19937 random_{5};
  std::vector<Vec> at_;
  Drift drift_;
};

TEST_F(ImpulseDrift, IsNothingForWhatMovesTogether) {
  const auto now = gone([](const Vec&) { return Vec(400, -30, 8, 0); });
  EXPECT_LT(drift_.between(at_, now), 1e-3F);
}

/// Shear: far bodies go 30 apart, near ones little.
TEST_F(ImpulseDrift, IsThatOfNeighbours) {
  const auto now = gone([](const Vec& p) { return Vec(0, p.x(), 0, 0); });
  const float found = drift_.between(at_, now);
  EXPECT_GE(found, largest(now));
  EXPECT_LT(found, 3 * (2 * 0.6F + gap)) << "three cells";
}

TEST_F(ImpulseDrift, IsNeverLessThanThatOfAnyNeighbours) {
  for (int k = 0; k < 20; ++k) {
    const auto now = gone([&](const Vec&) { return Vec(number(-1, 1), number(-1, 1), number(-1, 1), 0); });
    EXPECT_GE(drift_.between(at_, now), largest(now));
  }
}

TEST_F(ImpulseDrift, LeavesOutWhatIsNowhere) {
  std::vector<Vec> now = at_;
  now[3].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(drift_.between(at_, now), 0);
  EXPECT_EQ(Drift().between({}, {}), 0);
}

}  // namespace
}  // namespace moraine::impulse
