// SPDX-License-Identifier: Apache-2.0
// The sets of kernels of engine impulse do the same operations in the same order: the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

#include "physics/impulse/near_list.hpp"

namespace moraine::impulse {
namespace {

constexpr std::uint32_t bodies = 64;

/// Random balls that move, spin and overlap a little, and pairs of them that carried something. Those of the first
/// seven in a group of eight share no body.
struct Sample {
  std::vector<float> moving, before, position, carried;
  std::vector<std::uint32_t> material, lower, higher, pairs, close, meeting;
  std::vector<std::uint8_t> carries;
  std::vector<PairConstants> law{{0.5F, 0.3F}, {0.2F, 0}, {0.2F, 0}, {0, 0.8F}};
  std::vector<PairBatch> batches;
  StepNumbers numbers;
  PairFeatures features;

  explicit Sample(unsigned seed) : moving(8 * bodies), position(4 * bodies), batches(bodies) {
    std::mt19937 random(seed);
    const auto number = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    features = {seed % 2 == 0, seed % 3 != 0};
    numbers = {0.02F, 0.01F, 0.1F, seed % 3 == 1 ? 0.06F : 0, 0.99F, 0.01F, 50, 10};
    for (float& v : moving) v = number(-1, 1);
    for (std::uint32_t i = 0; i < bodies; ++i) {
      moving[8 * i + 3] = 0;
      moving[8 * i + 7] = number(0.5F, 2);
      for (int axis = 0; axis < 3; ++axis) {
        position[4 * i + axis] = number(0, 3);
        before.push_back(number(-1, 1));
      }
      before.push_back(0);
      position[4 * i + 3] = number(0.3F, 0.5F);
      material.push_back(random() % 2);
      carries.push_back(random() % 4 == 0);
    }
    for (std::uint32_t k = 0; k + 1 < bodies; k += 2) {
      lower.push_back(k);
      higher.push_back(k + 1);
      pairs.push_back(k / 2);
      for (int n = 0; n < 3; ++n) carried.push_back(number(-0.1F, 0.1F));
      carried.push_back(number(0, 1));
    }
    pairs.resize(pairs.size() - seed % batch_lanes);
    std::memset(batches.data(), 0, sizeof(PairBatch) * batches.size());
  }

  BodyArrays arrays() { return {moving.data(), position.data(), material.data(), carries.data(), before.data()}; }
  PairTable table() { return {lower.data(), higher.data(), lower.size()}; }
  /// Of all pairs but the first and the last.
  PairCarried carried_on() { return {1, static_cast<std::uint32_t>(lower.size() - 2), carried.data()}; }

  void find(const PairKernels& kernels) {
    close.resize(lower.size() + batch_lanes);
    meeting.resize(close.size());
    std::size_t count = 0;
    PairFindTask task{arrays(), table(), numbers, {law.data(), 2}, features, 0, lower.size() / 2 + 3, close.data()};
    for (; task.begin < task.end; task.begin = task.end, task.end = lower.size()) {
      task.out = meeting.data() + count;
      count += kernels.find(task);
    }
    meeting.resize(count);
  }
  void solve(const PairKernels& kernels) {
    const PairLaws laws{law.data(), 2};
    const std::size_t count = (pairs.size() + batch_lanes - 1) / batch_lanes;
    kernels.start(
        {arrays(), table(), numbers, laws, features, carried_on(), pairs.data(), pairs.size(), batches.data()});
    const PairTask task{arrays(), batches.data(), count, numbers, laws, features};
    for (int sweep = 0; sweep < 3; ++sweep) kernels.sweep(task);
    kernels.relax(task);
    kernels.carry({batches.data(), count, carried_on()});
  }
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(ImpulseKernels, AllSetsGiveTheSameBits) {
  const PairKernels* fast = avx2_pair_kernels();
  if (fast == nullptr) GTEST_SKIP() << "this processor has no AVX2";
  std::size_t found = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    Sample portable(seed), wide(seed);
    portable.find(portable_pair_kernels());
    wide.find(*fast);
    EXPECT_TRUE(same_bits(portable.meeting, wide.meeting)) << seed;
    found += wide.meeting.size();
    portable.solve(portable_pair_kernels());
    wide.solve(*fast);
    EXPECT_TRUE(same_bits(portable.moving, wide.moving)) << seed;
    EXPECT_TRUE(same_bits(portable.batches, wide.batches)) << seed;
    EXPECT_TRUE(same_bits(portable.carried, wide.carried)) << seed;
  }
  EXPECT_GT(found, 24U);
}

TEST(ImpulseKernels, KeepMomentum) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Sample s(seed);
    const auto momentum = [&](std::size_t axis) {
      double sum = 0;
      for (std::size_t i = 0; i < bodies; ++i) sum += static_cast<double>(s.moving[8 * i + axis] / s.moving[8 * i + 7]);
      return sum;
    };
    const double before[3] = {momentum(0), momentum(1), momentum(2)};
    const std::vector<float> start = s.moving;
    s.solve(pair_kernels());
    EXPECT_FALSE(same_bits(start, s.moving));
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(momentum(axis), before[axis], 1e-4);
  }
}

/// Rows of 0 to 30 pairs; some bodies have none.
TEST(ImpulseKernels, FindThePlacesOfPairs) {
  std::vector<std::uint32_t> lower, higher, begin{0};
  for (std::uint32_t a = 10; a < 41; ++a) {
    for (std::uint32_t b = 0; b < (7 * a) % 31; ++b) lower.push_back(a), higher.push_back(100 + 2 * b);
    begin.push_back(static_cast<std::uint32_t>(lower.size()));
  }
  const std::size_t count = lower.size();
  higher.resize(count + batch_lanes, 101);
  const auto place = [&](const PairKernels& kernels, std::uint32_t a, std::uint32_t b) {
    PairBatch batch{};
    std::fill_n(batch.a, batch_lanes, a);
    std::fill_n(batch.b, batch_lanes, b);
    kernels.place({{lower.data(), higher.data(), count}, {10, 31, begin.data()}, &batch, 1});
    return batch.pair[batch_lanes - 1];
  };
  for (const PairKernels* kernels : {&portable_pair_kernels(), &pair_kernels()}) {
    for (std::uint32_t k = 0; k < count; ++k) EXPECT_EQ(place(*kernels, lower[k], higher[k]), k);
    for (const std::uint32_t a : {0U, 9U, 12U, 40U, 41U, nowhere}) EXPECT_EQ(place(*kernels, a, 101), ~0U);
    EXPECT_EQ(place(*kernels, 12, nowhere), ~0U);
  }
}

/// Against all pairs, for sizes of three classes.
TEST(ImpulseNearList, HoldsThePairsWithinTheSkinInOrder) {
  std::mt19937 random(3);
  const auto number = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  std::vector<Vec> position;
  std::vector<std::uint8_t> passive;
  for (int i = 0; i < 600; ++i) {
    position.emplace_back(number(0, 8), number(-2, 3), number(0, 6), i % 40 == 0 ? 1.7F : number(0.2F, 0.5F));
    passive.push_back(i % 5 == 0);
  }
  NearList list;
  list.build(position, passive, 0.3F);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, found;
  for (std::uint32_t i = 0; i < position.size(); ++i)
    for (std::uint32_t j = i + 1; j < position.size(); ++j)
      if (!(passive[i] && passive[j]) &&
          three(position[i] - position[j]).norm() < position[i].w() + position[j].w() + 0.3F)
        expected.emplace_back(i, j);
  for (std::size_t k = 0; k < list.size(); ++k) found.emplace_back(list.lower()[k], list.higher()[k]);
  EXPECT_GT(found.size(), 1000U);
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace moraine::impulse
