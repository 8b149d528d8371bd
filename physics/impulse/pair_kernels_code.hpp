// SPDX-License-Identifier: Apache-2.0
// The kernels themselves, once per processor: included by files that are compiled with different options. All is local
// to them, so that the linker cannot mix them up. Formulas are explained in contact_row.hpp.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "physics/impulse/pair_kernels.hpp"

namespace moraine::impulse {
namespace {

#define MORAINE_INLINE [[gnu::always_inline]] inline

using F4 = float __attribute__((vector_size(16)));
using F8 = float __attribute__((vector_size(32)));
using I8 = std::int32_t __attribute__((vector_size(32)));

struct Wide {
  F8 x, y, z;
};

MORAINE_INLINE F8 load(const float* from) {
  F8 v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
MORAINE_INLINE void store(const F8& v, float* to) { __builtin_memcpy(to, &v, sizeof v); }
MORAINE_INLINE F4 load_four(const float* from) {
  F4 v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
MORAINE_INLINE Wide load(const float (&from)[3][batch_lanes]) { return {load(from[0]), load(from[1]), load(from[2])}; }
MORAINE_INLINE void store(const Wide& v, float (&to)[3][batch_lanes]) {
  store(v.x, to[0]);
  store(v.y, to[1]);
  store(v.z, to[2]);
}

MORAINE_INLINE F8 all(float v) { return F8{v, v, v, v, v, v, v, v}; }
MORAINE_INLINE F8 choose(const I8& which, const F8& yes, const F8& no) { return which ? yes : no; }
MORAINE_INLINE F8 larger(const F8& a, const F8& b) { return choose(a > b, a, b); }

/// Correctly rounded everywhere.
MORAINE_INLINE F8 root(const F8& v) {
#if defined(__AVX2__)
  return _mm256_sqrt_ps(v);
#elif defined(__SSE2__)
  const F4 low = _mm_sqrt_ps(__builtin_shufflevector(v, v, 0, 1, 2, 3));
  const F4 high = _mm_sqrt_ps(__builtin_shufflevector(v, v, 4, 5, 6, 7));
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#else
  F8 out;
  for (std::size_t k = 0; k < batch_lanes; ++k) out[k] = __builtin_sqrtf(v[k]);
  return out;
#endif
}

MORAINE_INLINE Wide operator+(const Wide& a, const Wide& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
MORAINE_INLINE Wide operator-(const Wide& a, const Wide& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
MORAINE_INLINE Wide operator*(const F8& s, const Wide& v) { return {s * v.x, s * v.y, s * v.z}; }
MORAINE_INLINE F8 dot(const Wide& a, const Wide& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
MORAINE_INLINE Wide cross(const Wide& a, const Wide& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Four {
  Wide xyz;
  F8 w;
};

/// The four numbers that start at from + stride index[k], for all k.
MORAINE_INLINE Four gather_four(const float* from, const std::uint32_t* index, std::size_t stride) {
  const auto pair = [&](std::size_t k) __attribute__((always_inline)) {
    return __builtin_shufflevector(load_four(from + stride * index[k]), load_four(from + stride * index[k + 4]), 0, 1,
                                   2, 3, 4, 5, 6, 7);
  };
  const F8 p = pair(0), q = pair(1), r = pair(2), s = pair(3);
  const F8 xy_low = __builtin_shufflevector(p, q, 0, 8, 1, 9, 4, 12, 5, 13);
  const F8 xy_high = __builtin_shufflevector(r, s, 0, 8, 1, 9, 4, 12, 5, 13);
  const F8 z_low = __builtin_shufflevector(p, q, 2, 10, 3, 11, 6, 14, 7, 15);
  const F8 z_high = __builtin_shufflevector(r, s, 2, 10, 3, 11, 6, 14, 7, 15);
  return {{__builtin_shufflevector(xy_low, xy_high, 0, 1, 8, 9, 4, 5, 12, 13),
           __builtin_shufflevector(xy_low, xy_high, 2, 3, 10, 11, 6, 7, 14, 15),
           __builtin_shufflevector(z_low, z_high, 0, 1, 8, 9, 4, 5, 12, 13)},
          __builtin_shufflevector(z_low, z_high, 2, 3, 10, 11, 6, 7, 14, 15)};
}
MORAINE_INLINE Wide gather(const float* from, const std::uint32_t* index, std::size_t stride) {
  return gather_four(from, index, stride).xyz;
}

/// The way back, with 0 as the fourth number, for the first `used` indices.
MORAINE_INLINE void scatter(const Wide& v, float* to, const std::uint32_t* index, std::size_t stride,
                            std::uint32_t used) {
  const F8 zero = all(0);
  const F8 xy_low = __builtin_shufflevector(v.x, v.y, 0, 8, 1, 9, 4, 12, 5, 13);
  const F8 xy_high = __builtin_shufflevector(v.x, v.y, 2, 10, 3, 11, 6, 14, 7, 15);
  const F8 z_low = __builtin_shufflevector(v.z, zero, 0, 8, 1, 9, 4, 12, 5, 13);
  const F8 z_high = __builtin_shufflevector(v.z, zero, 2, 10, 3, 11, 6, 14, 7, 15);
  const F8 records[4] = {__builtin_shufflevector(xy_low, z_low, 0, 1, 8, 9, 4, 5, 12, 13),
                         __builtin_shufflevector(xy_low, z_low, 2, 3, 10, 11, 6, 7, 14, 15),
                         __builtin_shufflevector(xy_high, z_high, 0, 1, 8, 9, 4, 5, 12, 13),
                         __builtin_shufflevector(xy_high, z_high, 2, 3, 10, 11, 6, 7, 14, 15)};
  const auto put = [&](std::size_t k) __attribute__((always_inline)) {
    const F8& r = records[k % 4];
    const F4 four = k < 4 ? __builtin_shufflevector(r, r, 0, 1, 2, 3) : __builtin_shufflevector(r, r, 4, 5, 6, 7);
    __builtin_memcpy(to + stride * index[k], &four, sizeof four);
  };
  if (used == batch_lanes)
#pragma GCC unroll 8
    for (std::size_t k = 0; k < batch_lanes; ++k) put(k);
  else
    for (std::size_t k = 0; k < used; ++k) put(k);
}

/// The velocities of a batch's bodies.
struct Bodies8 {
  Wide velocity_a, velocity_b, turning_a, turning_b;
};

template <bool Friction>
MORAINE_INLINE Bodies8 read(const PairBatch& batch, const float* moving) {
  Bodies8 m;
  m.velocity_a = gather(moving, batch.a, 8);
  m.velocity_b = gather(moving, batch.b, 8);
  if constexpr (Friction) {
    m.turning_a = gather(moving + 4, batch.a, 8);
    m.turning_b = gather(moving + 4, batch.b, 8);
  }
  return m;
}

/// Gives the bodies an impulse, the tangential part of which is `side`, and writes them back.
template <bool Friction>
MORAINE_INLINE void apply(const PairBatch& batch, Bodies8 m, const Wide& impulse, const Wide& side, const Wide& normal,
                          float* moving) {
  const F8 of_a = load(batch.inverse_mass_a), of_b = load(batch.inverse_mass_b);
  scatter(m.velocity_a + of_a * impulse, moving, batch.a, 8, batch.used);
  scatter(m.velocity_b - of_b * impulse, moving, batch.b, 8, batch.used);
  if constexpr (Friction) {
    const Wide turned = all(2.5F) * cross(side, normal);
    scatter(m.turning_a + of_a * turned, moving + 4, batch.a, 8, batch.used);
    scatter(m.turning_b + of_b * turned, moving + 4, batch.b, 8, batch.used);
  }
}

template <bool Friction>
MORAINE_INLINE void correct(PairBatch& batch, float* moving) {
  const Bodies8 m = read<Friction>(batch, moving);
  const Wide normal = load(batch.normal);
  Wide slip = m.velocity_a - m.velocity_b;
  if constexpr (Friction) slip = slip - cross(m.turning_a + m.turning_b, normal);
  const F8 parting = dot(normal, slip), before = load(batch.push);
  const F8 push =
      larger(before - load(batch.firmness) * (parting + load(batch.approach)) - load(batch.yielding) * before, all(0));
  store(push, batch.push);
  Wide impulse = (push - before) * normal, change{};
  if constexpr (Friction) {
    const Wide old = load(batch.side), across = slip - parting * normal;
    const Wide wanted = old - (all(2.0F / 7) * load(batch.mass)) * across;
    const F8 limit = load(batch.friction) * push, size2 = larger(dot(wanted, wanted), all(1e-30F));
    const Wide side = (limit / root(larger(size2, limit * limit))) * wanted;
    store(side, batch.side);
    change = side - old;
    impulse = impulse + change;
  }
  apply<Friction>(batch, m, impulse, change, normal, moving);
}

MORAINE_INLINE bool any(const I8& lanes) {
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < batch_lanes; ++k) sum |= lanes[k];
  return sum != 0;
}

MORAINE_INLINE void set_relaxed(PairBatch& batch, const float* position) {
  const F8 zero = all(0), push = load(batch.push), gap = load(batch.gap);
  const I8 carries = push > zero, apart = gap > zero;
  store(choose(carries, -load(batch.rebound), choose(apart, all(1e10F), zero)), batch.approach);
  __builtin_memcpy(batch.firmness, batch.mass, sizeof batch.mass);
  store(zero, batch.yielding);
  const I8 met = carries & apart;
  if (!any(met)) return;
  const Wide between = gather(position, batch.a, 4) - gather(position, batch.b, 4), old = load(batch.normal);
  const F8 distance = root(dot(between, between));
  const I8 turns = met & (distance > zero);
  store(Wide{choose(turns, between.x / distance, old.x), choose(turns, between.y / distance, old.y),
             choose(turns, between.z / distance, old.z)},
        batch.normal);
}

template <bool Friction>
void warm_start_all(const PairTask& task) {
  for (std::size_t k = 0; k < task.count; ++k) {
    const PairBatch& batch = task.batches[k];
    const Wide normal = load(batch.normal), side = load(batch.side);
    apply<Friction>(batch, read<Friction>(batch, task.moving), load(batch.push) * normal + side, side, normal,
                    task.moving);
  }
}

template <bool Friction>
void sweep_all(const PairTask& task) {
  for (std::size_t k = 0; k < task.count; ++k) correct<Friction>(task.batches[k], task.moving);
}

template <bool Friction>
void relax_all(const PairTask& task) {
  for (std::size_t k = 0; k < task.count; ++k) {
    set_relaxed(task.batches[k], task.position);
    correct<Friction>(task.batches[k], task.moving);
  }
}

void place(const PairPlacingTask& task) {
  for (std::size_t at = 0; at < task.count; at += batch_lanes) {
    std::uint32_t a[batch_lanes], b[batch_lanes];
    for (std::size_t k = 0; k < batch_lanes; ++k) {
      a[k] = task.lower[task.pairs[at + k]];
      b[k] = task.higher[task.pairs[at + k]];
    }
    const Four ball_a = gather_four(task.position, a, 4), ball_b = gather_four(task.position, b, 4);
    const Wide between = ball_a.xyz - ball_b.xyz;
    const F8 distance = root(dot(between, between)), inverse = all(1) / distance;
    const I8 apart = distance > all(0);
    const Wide normal{choose(apart, inverse * between.x, all(0)), choose(apart, inverse * between.y, all(0)),
                      choose(apart, inverse * between.z, all(1))};
    PairPlacing& out = task.out[at / batch_lanes];
    store(normal, out.normal);
    store(distance - ball_a.w - ball_b.w, out.gap);
    store(dot(normal, gather(task.moving, b, 8) - gather(task.moving, a, 8)), out.closing);
  }
}

void warm_start(const PairTask& task) { task.friction ? warm_start_all<true>(task) : warm_start_all<false>(task); }
void sweep(const PairTask& task) { task.friction ? sweep_all<true>(task) : sweep_all<false>(task); }
void relax(const PairTask& task) { task.friction ? relax_all<true>(task) : relax_all<false>(task); }

constexpr PairKernels kernels_of_this_file{place, warm_start, sweep, relax};

#undef MORAINE_INLINE

}  // namespace
}  // namespace moraine::impulse
