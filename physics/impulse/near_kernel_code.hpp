// SPDX-License-Identifier: Apache-2.0
// Which bodies lie near one, eight looked at at a time: once per processor, as pair_kernels_code.hpp.
#pragma once

#include "physics/impulse/lanes.hpp"

namespace moraine::impulse {
namespace {

struct CellRange {
  int low, high;
};
MORAINE_INLINE CellRange range(const Cells& cells, int axis, float x, float reach) {
  return {cells.along(axis, x - reach), cells.along(axis, x + reach)};
}

/// Appends the bodies above a number between two places of a table that are near the ball p.
MORAINE_INLINE std::uint32_t* append_near(const NearTask& task, const CellTable& t, const float* p, std::int32_t above,
                                          std::uint32_t from, std::uint32_t to, std::uint32_t* end) {
  for (std::uint32_t k = from; k < to; k += batch_lanes) {
    const Wide between{load(t.x + k) - all(p[0]), load(t.y + k) - all(p[1]), load(t.z + k) - all(p[2])};
    const F8 limit = load(t.radius + k) + all(p[3] + task.skin);
    I8 body;
    __builtin_memcpy(&body, t.body + k, sizeof body);
    const I8 near = (dot(between, between) < limit * limit) & (body > above);
    end = append(end, t.body + k, bits(near) & in_use(k, to));
  }
  return end;
}

std::size_t near(const NearTask& task, const float* p, std::int32_t above, std::uint32_t* out) {
  std::uint32_t* end = out;
  for (std::size_t c = 0; c < task.class_count; ++c) {
    const CellTable& t = task.classes[c];
    const float reach = p[3] + t.largest + task.skin;
    const CellRange x = range(t.cells, 0, p[0], reach), y = range(t.cells, 1, p[1], reach),
                    z = range(t.cells, 2, p[2], reach);
    for (int k = z.low; k <= z.high; ++k)
      for (int j = y.low; j <= y.high; ++j) {
        const std::uint32_t* row = t.start + (static_cast<std::size_t>(k) * t.cells.size[1] + j) * t.cells.size[0];
        end = append_near(task, t, p, above, row[x.low], row[x.high + 1], end);
      }
  }
  return static_cast<std::size_t>(end - out);
}

}  // namespace
}  // namespace moraine::impulse
