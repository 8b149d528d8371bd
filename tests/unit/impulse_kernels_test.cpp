// SPDX-License-Identifier: Apache-2.0
// The sets of kernels of engine impulse do the same operations in the same order: the same bits.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "physics/impulse/pair_kernels.hpp"

namespace moraine::impulse {
namespace {

constexpr std::size_t bodies = 64;

/// Random contacts of random bodies; most batches have spare lanes.
struct Sample {
  std::vector<PairBatch> batches;
  std::vector<float> moving, position;

  explicit Sample(unsigned seed) : batches(20), moving(8 * bodies), position(4 * bodies) {
    std::mt19937 random(seed);
    const auto number = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    for (std::size_t k = 0; k < moving.size(); ++k) moving[k] = k % 4 == 3 ? 0 : number(-1, 1);
    for (float& p : position) p = number(0, 5);
    for (PairBatch& b : batches) {
      std::memset(&b, 0, sizeof b);
      b.used = 1 + random() % batch_lanes;
      const auto first = static_cast<std::uint32_t>(random() % (bodies - 2 * batch_lanes));
      for (std::uint32_t k = 0; k < batch_lanes; ++k) {
        const std::uint32_t lane = k < b.used ? k : 0;
        b.a[k] = first + 2 * lane;
        b.b[k] = first + 2 * lane + 1;
        b.normal[k % 3][k] = 1;
        for (auto& side : b.side) side[k] = number(-0.1F, 0.1F);
        b.inverse_mass_a[k] = number(0.5F, 2);
        b.inverse_mass_b[k] = number(0.5F, 2);
        b.push[k] = random() % 3 == 0 ? 0 : number(0, 1);
        b.approach[k] = number(-0.5F, 0.5F);
        b.mass[k] = 1 / (b.inverse_mass_a[k] + b.inverse_mass_b[k]);
        b.friction[k] = number(0, 1);
        b.firmness[k] = number(0, 1) * b.mass[k];
        b.yielding[k] = number(0, 0.5F);
        b.rebound[k] = number(0, 1);
        b.gap[k] = number(-0.1F, 0.1F);
      }
    }
  }

  void solve(const PairKernels& kernels, bool friction) {
    const PairTask task{batches.data(), batches.size(), moving.data(), position.data(), friction};
    kernels.warm_start(task);
    for (int sweep = 0; sweep < 3; ++sweep) kernels.sweep(task);
    kernels.relax(task);
  }

  std::vector<PairPlacing> place(const PairKernels& kernels) const {
    std::vector<std::uint32_t> lower, higher, pairs;
    for (std::uint32_t k = 0; k < bodies; ++k) {
      pairs.push_back(k);
      lower.push_back(k);
      higher.push_back((7 * k + 1) % bodies);
    }
    std::vector<PairPlacing> out(pairs.size() / batch_lanes);
    kernels.place(
        {lower.data(), higher.data(), pairs.data(), pairs.size(), moving.data(), position.data(), out.data()});
    return out;
  }
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(ImpulseKernels, AllSetsGiveTheSameBits) {
  const PairKernels* fast = avx2_pair_kernels();
  if (fast == nullptr) GTEST_SKIP() << "this processor has no AVX2";
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Sample portable(seed), wide(seed);
    EXPECT_TRUE(same_bits(portable.place(portable_pair_kernels()), wide.place(*fast)));
    portable.solve(portable_pair_kernels(), seed % 2 == 0);
    wide.solve(*fast, seed % 2 == 0);
    EXPECT_TRUE(same_bits(portable.moving, wide.moving));
    EXPECT_TRUE(same_bits(portable.batches, wide.batches));
  }
}

TEST(ImpulseKernels, KeepMomentumAndChangeNothingInSpareLanes) {
  Sample s(5);
  for (PairBatch& b : s.batches)
    for (std::uint32_t k = 0; k < batch_lanes; ++k) b.inverse_mass_a[k] = b.inverse_mass_b[k] = 1;
  const auto momentum = [&](std::size_t axis) {
    double sum = 0;
    for (std::size_t i = 0; i < bodies; ++i) sum += s.moving[8 * i + axis];
    return sum;
  };
  const double before[3] = {momentum(0), momentum(1), momentum(2)};
  const std::vector<float> start = s.moving;
  s.solve(pair_kernels(), true);
  EXPECT_FALSE(same_bits(start, s.moving));
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(momentum(axis), before[axis], 1e-4);
}

}  // namespace
}  // namespace moraine::impulse
