// SPDX-License-Identifier: Apache-2.0
// What contacts of a step are prepared with. Nothing but plain numbers here: kernels of several processors include it.
#pragma once

namespace moraine::impulse {

/// In scaled units; StepRule works them out.
struct StepNumbers {
  static constexpr float push_limit = 1;        ///< overlaps are removed no faster
  static constexpr float largest_reach = 0.5F;  ///< [diameters] lists hold what is within reach
  static constexpr float again =
      0.5F;  ///< largest rebound of a shared body in the step after an impact, of the one before

  float h = 0;
  float slack = 0;      ///< gap that neighbours may close by pushing
  float reach = 0;      ///< contacts are looked for up to this gap
  float threshold = 0;  ///< slower impacts do not rebound
  float mass_scale = 1, impulse_scale = 0;
  float closing = 0, opening = 0;  ///< speeds per gap and per overlap
};

struct PairConstants {
  float friction = 0;
  float restitution = 0;
};

}  // namespace moraine::impulse
