// SPDX-License-Identifier: Apache-2.0
// Bodies go on with their velocities, eight at a time: once per processor, as pair_kernels_code.hpp.
#pragma once

#include "physics/impulse/lanes.hpp"

namespace moraine::impulse {
namespace {

/// Sine over angle and cosine of an angle.
struct Turn {
  F8 sine, cosine;
};
/// Given its square: exact to float32 up to angles of 0.8.
MORAINE_INLINE Turn short_turn(const F8& a) {
  return {all(1) - a * (all(1.0F / 6) - a * (all(1.0F / 120) - a * all(1.0F / 5040))),
          all(1) - a * (all(0.5F) - a * (all(1.0F / 24) - a * (all(1.0F / 720) - a * all(1.0F / 40320))))};
}
/// Up to 3.2: a revolution of a body within a step; larger ones are cut. Other lanes of the batch do not matter.
MORAINE_INLINE Turn turn_by(const F8& angle2) {
  const I8 large = angle2 > all(0.64F);
  const Turn direct = short_turn(angle2);
  if (bits(large) == 0) return direct;
  const F8 cut = smaller(angle2, all(10.24F));
  Turn t = short_turn(cut / all(16));
  for (int doubling = 0; doubling < 2; ++doubling) t = {t.sine * t.cosine, all(2) * t.cosine * t.cosine - all(1)};
  t.sine = t.sine * root(cut / angle2);
  return {choose(large, t.sine, direct.sine), choose(large, t.cosine, direct.cosine)};
}

/// The quaternion q turned by the rotation vector 2 `half`, world frame, its length kept near 1.
MORAINE_INLINE Four turned(const Four& q, const Wide& half) {
  const Turn t = turn_by(dot(half, half));
  const Wide v = t.cosine * q.xyz + t.sine * (q.w * half + cross(half, q.xyz));
  const F8 w = t.cosine * q.w - t.sine * dot(half, q.xyz);
  const F8 scale = all(1.5F) - all(0.5F) * (dot(v, v) + w * w);
  return {scale * v, scale * w};
}

void advance(const AdvanceTask& task) {
  for (std::size_t at = 0; at < task.count; at += batch_lanes) {
    std::uint32_t body[batch_lanes];
    for (std::size_t k = 0; k < batch_lanes; ++k)
      body[k] = static_cast<std::uint32_t>(at + k < task.count ? at + k : at);
    Four ball = gather(task.position, body, 4);
    ball.xyz = ball.xyz + all(task.h) * gather(task.moving, body, 8).xyz;
    scatter(ball, task.position, body, 4);
    if (!task.turn) continue;
    const F8 half = all(0.5F * task.h) / ball.w;
    const Four q = gather(task.attitude, body, 4);
    scatter(turned(q, half * gather(task.moving + 4, body, 8).xyz), task.attitude, body, 4);
  }
}

}  // namespace
}  // namespace moraine::impulse
