// SPDX-License-Identifier: Apache-2.0
// The numbers of a world's steps, in scaled units.
#pragma once

#include <vector>

#include "physics/impulse/contact_row.hpp"
#include "physics/impulse/step_numbers.hpp"

namespace moraine::impulse {

class StepRule {
 public:
  StepRule(const WorldSettings& settings, const Units& units);

  float h = 0;
  Vec fall = Vec::Zero();        ///< velocity that gravity adds in a step
  int sweeps = 1, relaxing = 1;  ///< before and after positions
  bool friction = false, restitution = false;

  const StepNumbers& numbers() const { return numbers_; }
  const PairConstants& of(std::uint32_t a, std::uint32_t b) const { return constants_[a * materials_ + b]; }
  const std::vector<PairConstants>& constants() const { return constants_; }
  std::size_t materials() const { return materials_; }
  /// Contacts are looked for up to this gap.
  float reach() const { return numbers_.reach; }
  /// Completes a row that has its mass, for surfaces `gap` apart that close at this speed. False if they do not meet in
  /// this step. Those that will bounce meet when they overlap: then the rebound itself takes the overlap back, and one
  /// impulse at one place keeps energy and angular momentum. But shared bodies, of which other worlds hold copies, must
  /// meet in all of them in the same step. Pairs are prepared by the kernels in the same way.
  bool prepare(ContactRow& row, float gap, float closing, const PairConstants& law, bool shared) const {
    const StepNumbers& n = numbers_;
    row.gap = gap;
    row.friction = law.friction;
    row.rebound = closing > n.threshold ? law.restitution * closing : 0;
    const bool bounces = row.rebound > 0 && !shared, hard = bounces || gap > 0;
    row.firmness = hard ? row.mass : n.mass_scale * row.mass;
    row.yielding = hard ? 0 : n.impulse_scale;
    const float opening = std::min(n.opening * positive(-gap), StepNumbers::push_limit);
    row.approach = bounces ? -row.rebound : n.closing * positive(gap) - opening;
    return gap < (bounces ? 0 : range(closing));
  }
  /// The largest gap across which surfaces that close at this speed may meet in this step.
  float range(float closing) const { return std::min(numbers_.slack + h * positive(closing), numbers_.reach); }

 private:
  std::size_t materials_ = 0;
  std::vector<PairConstants> constants_;
  StepNumbers numbers_;
};

}  // namespace moraine::impulse
