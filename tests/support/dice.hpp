// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "ghosting/coupling.hpp"

namespace moraine::test {

/// Random quantities from a seed.
class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 vec(double reach) { return {in(-reach, reach), in(-reach, reach), in(-reach, reach)}; }
  Quat turn() { return Quat(in(-1, 1), in(-1, 1), in(-1, 1), in(-1, 1)).normalized(); }
  CopyMotion motion() { return {vec(0.1), vec(0.1), {vec(3), vec(3)}}; }

 private:
  std::mt19937 random_;
};

}  // namespace moraine::test
