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
  bool friction = false;

  const PairConstants& of(std::uint32_t a, std::uint32_t b) const { return constants_[a * materials_ + b]; }
  /// Contacts are looked for up to this gap.
  float reach() const { return reach_; }
  /// Completes a row that has its mass, for surfaces `gap` apart that close at this speed. False if they do not meet in
  /// this step. Those that will bounce meet when they overlap: then the rebound itself takes the overlap back, and one
  /// impulse at one place keeps energy and angular momentum. But shared bodies, of which other worlds hold copies, must
  /// meet in all of them in the same step.
  bool prepare(ContactRow& row, float gap, float closing, const PairConstants& law, bool shared) const {
    row.gap = gap;
    row.friction = law.friction;
    row.rebound = closing > threshold_ ? law.restitution * closing : 0;
    const bool bounces = row.rebound > 0 && !shared, hard = bounces || gap > 0;
    row.firmness = hard ? row.mass : mass_scale_ * row.mass;
    row.yielding = hard ? 0 : impulse_scale_;
    const float opening = std::min(opening_ * positive(-gap), push_limit);
    row.approach = bounces ? -row.rebound : closing_ * positive(gap) - opening;
    return gap < (bounces ? 0 : range(closing));
  }
  /// The largest gap across which surfaces that close at this speed may meet in this step.
  float range(float closing) const { return std::min(slack_ + h * positive(closing), reach_); }

 private:
  static constexpr float push_limit = 1;

  std::size_t materials_ = 0;
  std::vector<PairConstants> constants_;
  float slack_ = 0, reach_ = 0, threshold_ = 0;
  float mass_scale_ = 1, impulse_scale_ = 0;
  float closing_ = 0, opening_ = 0;  ///< speeds per gap and per overlap
};

}  // namespace moraine::impulse
