// SPDX-License-Identifier: Apache-2.0
// Eight floats at once, for files that are compiled for several processors. All is local to the file that includes it,
// so that the linker cannot mix them up; the same operations in the same order everywhere.
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
/// Three numbers and one more.
struct Four {
  Wide xyz;
  F8 w;
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
MORAINE_INLINE F8 smaller(const F8& a, const F8& b) { return choose(a < b, a, b); }

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

/// One bit for each lane that is true.
MORAINE_INLINE unsigned bits(const I8& lanes) {
#if defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
#else
  std::int32_t each[batch_lanes];  // GCC 12 reads lanes[k] wrongly when it sanitizes
  __builtin_memcpy(each, &lanes, sizeof each);
  unsigned sum = 0;
  for (unsigned k = 0; k < batch_lanes; ++k) sum |= (each[k] != 0 ? 1U : 0U) << k;
  return sum;
#endif
}

#if defined(__AVX2__)
/// Every set of lanes as their numbers in order, four bits each.
struct LaneLists {
  std::uint32_t of[1U << batch_lanes] = {};
  constexpr LaneLists() {
    for (unsigned lanes = 0; lanes < 1U << batch_lanes; ++lanes)
      for (unsigned k = 0, at = 0; k < batch_lanes; ++k)
        if (lanes >> k & 1U) of[lanes] |= k << 4 * at++;
  }
};
constexpr LaneLists lane_lists;
#endif

/// Writes the numbers of those lanes; returns the new end. There must be room for eight.
MORAINE_INLINE std::uint32_t* append(std::uint32_t* end, const std::uint32_t* numbers, unsigned lanes) {
#if defined(__AVX2__)
  const __m256i list = _mm256_set1_epi32(static_cast<int>(lane_lists.of[lanes]));
  const __m256i order = _mm256_srlv_epi32(list, _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28));
  const __m256i from = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(numbers));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(end), _mm256_permutevar8x32_epi32(from, order));
  return end + __builtin_popcount(lanes);
#else
  for (std::size_t k = 0; k < batch_lanes; ++k) {
    *end = numbers[k];
    end += lanes >> k & 1U;
  }
  return end;
#endif
}
/// The lanes from `at` that are below `end`.
MORAINE_INLINE unsigned in_use(std::size_t at, std::size_t end) {
  return end - at >= batch_lanes ? 0xFFU : (1U << (end - at)) - 1U;
}

MORAINE_INLINE Wide operator+(const Wide& a, const Wide& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
MORAINE_INLINE Wide operator-(const Wide& a, const Wide& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
MORAINE_INLINE Wide operator*(const F8& s, const Wide& v) { return {s * v.x, s * v.y, s * v.z}; }
MORAINE_INLINE F8 dot(const Wide& a, const Wide& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
MORAINE_INLINE Wide cross(const Wide& a, const Wide& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The four numbers that start at from + stride index[k], for all k.
MORAINE_INLINE Four gather(const float* from, const std::uint32_t* index, std::size_t stride) {
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

/// The way back.
MORAINE_INLINE void scatter(const Four& v, float* to, const std::uint32_t* index, std::size_t stride) {
  const F8 xy_low = __builtin_shufflevector(v.xyz.x, v.xyz.y, 0, 8, 1, 9, 4, 12, 5, 13);
  const F8 xy_high = __builtin_shufflevector(v.xyz.x, v.xyz.y, 2, 10, 3, 11, 6, 14, 7, 15);
  const F8 zw_low = __builtin_shufflevector(v.xyz.z, v.w, 0, 8, 1, 9, 4, 12, 5, 13);
  const F8 zw_high = __builtin_shufflevector(v.xyz.z, v.w, 2, 10, 3, 11, 6, 14, 7, 15);
  const auto put = [&](const F8& records, std::size_t k) __attribute__((always_inline)) {
    const F4 low = __builtin_shufflevector(records, records, 0, 1, 2, 3);
    const F4 high = __builtin_shufflevector(records, records, 4, 5, 6, 7);
    __builtin_memcpy(to + stride * index[k], &low, sizeof low);
    __builtin_memcpy(to + stride * index[k + 4], &high, sizeof high);
  };
  put(__builtin_shufflevector(xy_low, zw_low, 0, 1, 8, 9, 4, 5, 12, 13), 0);
  put(__builtin_shufflevector(xy_low, zw_low, 2, 3, 10, 11, 6, 7, 14, 15), 1);
  put(__builtin_shufflevector(xy_high, zw_high, 0, 1, 8, 9, 4, 5, 12, 13), 2);
  put(__builtin_shufflevector(xy_high, zw_high, 2, 3, 10, 11, 6, 7, 14, 15), 3);
}

}  // namespace
}  // namespace moraine::impulse
