// SPDX-License-Identifier: Apache-2.0
// Contacts solved eight at a time. Nothing but plain arrays here: what includes it is compiled for several processors.
#pragma once

#include <cstddef>
#include <cstdint>

namespace moraine::impulse {

inline constexpr std::size_t batch_lanes = 8;

/// Up to eight pair contacts that share no body. Fields as in PairRow. Spare lanes repeat the first one and are never
/// written back.
struct alignas(32) PairBatch {
  using Lanes = float[batch_lanes];

  std::uint32_t a[batch_lanes], b[batch_lanes];
  std::uint32_t row[batch_lanes];  ///< that the lane came from
  std::uint32_t used;              ///< lanes
  Lanes inverse_mass_a, inverse_mass_b;
  Lanes normal[3], side[3];
  Lanes push, approach, mass, friction, firmness, yielding, rebound, gap;
};

/// The contacts of a step and the bodies between which they act, for one call of a kernel.
struct PairTask {
  PairBatch* batches = nullptr;
  std::size_t count = 0;
  float* moving = nullptr;          ///< of body i from 8 i: velocity, 0, radius times angular velocity, 0
  const float* position = nullptr;  ///< of body i from 4 i: x, y, z, radius
  bool friction = false;
};

/// How eight pairs lie and move; a pair is a place in the list.
struct alignas(32) PairPlacing {
  PairBatch::Lanes normal[3];  ///< unit, towards the lower one
  PairBatch::Lanes gap, closing;
};

struct PairPlacingTask {
  const std::uint32_t *lower = nullptr, *higher = nullptr;  ///< the list
  const std::uint32_t* pairs = nullptr;                     ///< a multiple of eight, indices into the list
  std::size_t count = 0;
  const float *moving = nullptr, *position = nullptr;  ///< as in PairTask
  PairPlacing* out = nullptr;
};

/// One set of kernels. All sets do the same operations in the same order, so they give the same bits.
struct PairKernels {
  void (*place)(const PairPlacingTask&);
  void (*warm_start)(const PairTask&);
  void (*sweep)(const PairTask&);
  /// The sweep after bodies have moved: what remains is to part with the right speed. Contacts that met within the step
  /// do so along the line on which they touch: that keeps angular momentum.
  void (*relax)(const PairTask&);
};

/// For any processor.
const PairKernels& portable_pair_kernels();
/// Null where compiler or processor lack AVX2.
const PairKernels* avx2_pair_kernels();
/// The fastest set; the portable one if the environment says MORAINE_SIMD=portable, for tests.
const PairKernels& pair_kernels();

}  // namespace moraine::impulse
