// SPDX-License-Identifier: Apache-2.0
// Contacts found and solved eight at a time. Nothing but plain arrays here: what includes it is compiled for several
// processors.
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/impulse/step_numbers.hpp"

namespace moraine::impulse {

inline constexpr std::size_t batch_lanes = 8;

/// Up to eight pair contacts that share no body. Spare lanes repeat the first one: they compute and write the same.
/// Impulses act on a, the opposite ones on b. What can be worked out again is not kept: sweeps wait for memory.
struct alignas(32) PairBatch {
  using Lanes = float[batch_lanes];

  std::uint32_t a[batch_lanes], b[batch_lanes];
  std::uint32_t pair[batch_lanes];  ///< place in the list of pairs that there was in their step
  Lanes normal[3];                  ///< unit, towards a
  Lanes side[3];                    ///< tangential impulse of the step so far
  Lanes push;                       ///< normal impulse of the step so far, 0 or more
  Lanes approach;                   ///< as in ContactRow; above 0 if and only if there is a gap
  Lanes rebound;                    ///< speed after an impact; negative if the contact is soft all the same
};

/// The bodies of a world, by place.
struct BodyArrays {
  float* moving = nullptr;          ///< from 8 i: velocity, 0, radius times angular velocity, inverse mass
  const float* position = nullptr;  ///< from 4 i: x, y, z, radius
  const std::uint32_t* material = nullptr;
  const std::uint8_t* carries = nullptr;  ///< see Body
  const float* before = nullptr;          ///< from 4 i: velocity at the start of the step; read if anything rebounds
};

/// Pairs that may meet, ascending, with a spare batch behind the last.
struct PairTable {
  const std::uint32_t *lower = nullptr, *higher = nullptr;
  std::size_t count = 0;
};

/// What contacts of neighbouring pairs of a table carry on from one step to the next.
struct PairCarried {
  std::uint32_t first = 0, count = 0;  ///< pairs
  /// From 4 (pair - first): tangential impulse, normal impulse. After an impact: 0 and the negative speed of the
  /// rebound. A spare one at the end takes what other pairs carry.
  float* of = nullptr;
};

/// What is left out if a scene does not use it.
struct PairFeatures {
  bool friction = false, restitution = false;
};

struct PairLaws {
  const PairConstants* of = nullptr;  ///< materials x materials
  std::size_t materials = 0;
};

struct PairFindTask {
  BodyArrays bodies;
  PairTable table;
  StepNumbers numbers;
  PairLaws laws;
  PairFeatures features;
  std::size_t begin = 0, end = 0;  ///< places in the table
  std::uint32_t* close = nullptr;  ///< room for all of them and a batch
  std::uint32_t* out = nullptr;    ///< the same
};

struct PairStartTask {
  BodyArrays bodies;
  PairTable table;
  StepNumbers numbers;
  PairLaws laws;
  PairFeatures features;
  PairCarried carried;                   ///< at least of these pairs
  const std::uint32_t* pairs = nullptr;  ///< places in the table; no two share a body
  std::size_t count = 0;
  PairBatch* batches = nullptr;  ///< room for all of them
};

struct PairTask {
  BodyArrays bodies;
  PairBatch* batches = nullptr;
  std::size_t count = 0;
  StepNumbers numbers;
  PairLaws laws;
  PairFeatures features;
};

/// Where the pairs of neighbouring lower bodies begin in a table.
struct PairRows {
  std::uint32_t first = 0, count = 0;    ///< bodies
  const std::uint32_t* begin = nullptr;  ///< by body, and the end of the last one's
};

struct PairPlaceTask {
  PairTable table;
  PairRows rows;
  PairBatch* batches = nullptr;
  std::size_t count = 0;
};

struct PairCarryTask {
  const PairBatch* batches = nullptr;
  std::size_t count = 0;
  PairCarried to;
};

/// A box of cells.
struct Cells {
  float low[3] = {}, inverse[3] = {};  ///< corner of the first cell; cells per length
  int size[3] = {1, 1, 1};

  /// The nearest one for what lies outside, the first one for what is nowhere. Always inlined: what includes it is
  /// compiled for several processors, and the linker must not choose one of them.
  [[gnu::always_inline]] int along(int axis, float x) const {
    const float c = (x - low[axis]) * inverse[axis];
    const int last = size[axis] - 1;
    return c > 0 ? (c < static_cast<float>(last) ? static_cast<int>(c) : last) : 0;
  }
};

/// Bodies in the order of the cells in which they lie.
struct CellTable {
  Cells cells;
  const std::uint32_t* start;       ///< of every cell, x first
  const float *x, *y, *z, *radius;  ///< with spare lanes at the end
  const std::uint32_t* body;
  float largest;  ///< radius
};

struct NearTask {
  float skin = 0;
  const CellTable* classes = nullptr;
  std::size_t class_count = 0;
};

struct AdvanceTask {
  float* position = nullptr;      ///< BodyArrays
  const float* moving = nullptr;  ///< BodyArrays
  float* attitude = nullptr;      ///< quaternions x, y, z, w
  std::size_t count = 0;
  float h = 0;
  bool turn = false;
};

/// One set of kernels. All sets do the same operations in the same order, so they give the same bits.
struct PairKernels {
  /// Writes the bodies with numbers above this one whose surfaces are less than the skin away from a ball (x, y, z,
  /// radius), in any order; returns how many. Room for all bodies and a batch is needed.
  std::size_t (*near)(const NearTask&, const float* ball, std::int32_t above, std::uint32_t* out);
  /// Writes the places of those pairs that may meet in this step, ascending; returns how many. Before gravity acts.
  std::size_t (*find)(const PairFindTask&);
  /// Fills batches and gives bodies the impulses of the step before, turned with the contact.
  void (*start)(const PairStartTask&);
  void (*sweep)(const PairTask&);
  /// A sweep after bodies have moved: what remains is to part with the right speed. Contacts that met within the step
  /// do so along the line on which they touch: that keeps angular momentum.
  void (*relax)(const PairTask&);
  /// Gives contacts the places in the table of the pairs that have their bodies; those that have none get ~0.
  void (*place)(const PairPlaceTask&);
  /// Writes what contacts carry on after the last sweep of a step.
  void (*carry)(const PairCarryTask&);
  /// Moves bodies by their velocities over h, and turns them. Turns of more than a revolution come out smaller.
  void (*advance)(const AdvanceTask&);
};

/// For any processor.
const PairKernels& portable_pair_kernels();
/// Null where compiler or processor lack AVX2.
const PairKernels* avx2_pair_kernels();
/// The fastest set; the portable one if the environment says MORAINE_SIMD=portable, for tests.
const PairKernels& pair_kernels();

}  // namespace moraine::impulse
