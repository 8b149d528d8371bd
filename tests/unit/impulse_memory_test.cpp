// SPDX-License-Identifier: Apache-2.0
// What engine impulse keeps per element, and in which blocks.
#include <gtest/gtest.h>
#include <malloc.h>

#include <set>
#include <utility>

#include "ghosting/model.hpp"
#include "physics/impulse/batch_store.hpp"
#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool malloc_is_ours = false;
#else
constexpr bool malloc_is_ours = true;
#endif

double allocated() {
  const auto m = mallinfo2();
  return static_cast<double>(m.uordblks + m.hblkhd);
}

/// A packed dam: 5.8 contacts per element.
TEST(ImpulseMemory, IsSmall) {
  if (!malloc_is_ours) GTEST_SKIP() << "a sanitizer allocates";
  const Scene scene = test::example("dam", {{"count", "20000"}, {"time.dt", "1 / 60"}, {"run.iterations", "4"}});
  const auto count = static_cast<double>(scene.elements.size());
  const WorldSettings settings = world_settings(scene);
  const double before = allocated();
  const auto world = find_engine("impulse").make(settings, Vec3::Zero());
  for (const Element& e : scene.elements) world->add({e.id, e.shape, e.material, e.mass, Role::real, e.state});
  double contacts = 0;
  for (int step = 0; step < 30; ++step) {
    world->step(settings.substep * step);
    contacts = std::max(contacts, static_cast<double>(world->work().contacts));
  }
  EXPECT_GT(contacts, 5.5 * count);
  EXPECT_LT(allocated() - before, 600 * count);
}

/// Groups 0, 2, 4 ... of `size` batches, marked by group and place.
void fill(impulse::BatchStore& store, std::uint32_t size) {
  for (std::uint32_t group = 0; group < 20; group += 2) {
    for (std::uint32_t k = 0; k < size; ++k) store.add(1).front().pair[0] = 100 * group + k;
    store.end_group(group);
  }
}

TEST(ImpulseBatches, AreTakenByGroup) {
  impulse::BatchStore store;
  fill(store, 50);
  store.renew();
  EXPECT_EQ(store.size(), 0U);
  const auto taken = [&](ElementId group) {
    std::vector<std::uint32_t> pairs;
    store.take(group, [&](std::span<impulse::PairBatch> batches) {
      for (const impulse::PairBatch& b : batches) pairs.push_back(b.pair[0]);
    });
    return pairs;
  };
  EXPECT_TRUE(taken(3).empty()) << "there is none, and those before it are forgotten";
  EXPECT_TRUE(taken(2).empty());
  const std::vector<std::uint32_t> fourth = taken(6);
  ASSERT_EQ(fourth.size(), 50U);
  for (std::uint32_t k = 0; k < 50; ++k) EXPECT_EQ(fourth[k], 600 + k);
}

TEST(ImpulseBatches, KeepTheirOrderWhileMemoryIsReused) {
  impulse::BatchStore store;
  std::set<const void*> blocks;
  for (std::uint32_t step = 0; step < 30; ++step) {
    store.renew();
    for (std::uint32_t group = 0; group < 8; ++group) {
      store.take(group, [](std::span<impulse::PairBatch>) {});
      for (std::uint32_t k = 0; k < 90 + step % 3; ++k) store.add(1).front().pair[0] = 1000 * group + k;
      store.end_group(group);
    }
    store.take_rest();
    std::uint32_t last = 0;
    store.each([&](std::span<impulse::PairBatch> batches) {
      blocks.insert(batches.data());
      for (const impulse::PairBatch& b : batches) EXPECT_GE(b.pair[0], std::exchange(last, b.pair[0]));
    });
    EXPECT_EQ(store[95 + step % 3].pair[0], 1005U);
  }
  EXPECT_LT(blocks.size(), 8U * 92 / 32 + 6) << "never two sets";
}

}  // namespace
}  // namespace moraine
