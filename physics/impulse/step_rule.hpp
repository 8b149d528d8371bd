// SPDX-License-Identifier: Apache-2.0
// The numbers of a world's steps, in scaled units.
#pragma once

#include <vector>

#include "physics/impulse/contact_row.hpp"

namespace moraine::impulse {

struct PairConstants {
  float friction = 0;
  float restitution = 0;
};

class StepRule {
 public:
  StepRule(const WorldSettings& settings, const Units& units);

  float h = 0;
  Vec fall = Vec::Zero();  ///< velocity that gravity adds in a step
  int sweeps = 1;
  bool friction = false, restitution = false;
  Softness softness;

  const PairConstants& of(std::uint32_t a, std::uint32_t b) const { return constants_[a * materials_ + b]; }
  /// Whether surfaces that close at this speed may meet in this step.
  bool near(float gap, float closing) const { return gap < slack_ + h * std::max(closing, 0.0F); }
  /// The `approach` of a row with this gap.
  float approach(float gap) const { return gap > 0 ? gap / h : std::max(gap * recovery_ / h, -push_limit); }
  /// Speed after an impact; 0 if it is too slow to bounce.
  float rebound(float restitution_, float closing) const { return closing > threshold_ ? restitution_ * closing : 0; }

  /// Contacts are looked for up to this gap.
  static constexpr float reach = 0.1F;

 private:
  static constexpr float push_limit = 1;

  std::size_t materials_ = 0;
  std::vector<PairConstants> constants_;
  float slack_ = 0, recovery_ = 0, threshold_ = 0;
};

}  // namespace moraine::impulse
