// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/step_rule.hpp"

namespace moraine::impulse {
namespace {

constexpr double contact_damping = 10;      ///< ratio; Box2D's: overlaps are removed without springing back
constexpr double least_stiffness = 20;      ///< h w (2 z + h w): contacts stay firm however slowly overlaps are removed
constexpr float gap_slack = 0.005F;         ///< [diameters] neighbours may push bodies this far together within a step
constexpr float fast_impact = 4;            ///< faster ones are found when they overlap already [sqrt(g d)]
constexpr float largest_way = 0.15F;        ///< of an impact within a step that is looked ahead for [diameters]
constexpr float bounce_threshold = 0.064F;  ///< slower impacts do not bounce [sqrt(g d)]; 0.2 m/s for 1 m under 1 g

/// With overlap_recovery b = h w / (2 z + h w), the share of an overlap that a step removes (w: natural frequency, z:
/// damping ratio of the contact), h w (2 z + h w) = 4 z^2 b / (1 - b)^2 (Catto 2011).
double impulse_scale(double recovery) {
  const double a = 4 * contact_damping * contact_damping * recovery / ((1 - recovery) * (1 - recovery));
  return 1 / (1 + std::max(a, least_stiffness));
}

}  // namespace

StepRule::StepRule(const WorldSettings& settings, const Units& units)
    : h(static_cast<float>(settings.substep / units.time)),
      fall(narrow(settings.substep / units.velocity() * settings.gravity)),
      sweeps((settings.iterations + 1) / 2),
      relaxing(settings.iterations + 1 - sweeps),
      friction(settings.features.friction),
      restitution(settings.features.restitution),
      materials_(settings.scene->materials.materials.size()) {
  for (const PairLaw& law : settings.scene->materials.pairs)
    constants_.push_back({static_cast<float>(law.friction), static_cast<float>(law.restitution)});
  StepNumbers& n = numbers_;
  n.h = h;
  n.slack = gap_slack + h * fall.norm();
  n.reach = std::min(n.slack + std::min(fast_impact * h, largest_way), StepNumbers::largest_reach);
  n.threshold = settings.gravity.isZero() ? 0 : bounce_threshold;
  n.impulse_scale = static_cast<float>(impulse_scale(settings.overlap_recovery));
  n.mass_scale = 1 - n.impulse_scale;
  n.closing = 1 / h;
  n.opening = static_cast<float>(settings.overlap_recovery) / h;
}

}  // namespace moraine::impulse
