// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/start_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "physics/errors.hpp"
#include "physics/initial_overlap.hpp"
#include "physics/scene/bonds.hpp"
#include "physics/soft_sphere/contact_force.hpp"

namespace moraine::soft_sphere {
namespace {

constexpr double most_typical_speeds = 10;

/// At which what the contact holds drives its bodies apart [m/s].
double parting_speed(const Scene& scene, const InitialOverlap& s) {
  const ContactLaws laws(scene);
  const Element& a = *find_element(scene.elements, s.element);
  const Element* b = s.with_boundary ? nullptr : find_element(scene.elements, s.other);
  const double ra = scene.shape_of(a).bounding_radius, rb = b ? scene.shape_of(*b).bounding_radius : ra;
  const double radius = b ? ra * rb / (ra + rb) : ra;
  const double mass = b ? a.mass * b->mass / (a.mass + b->mass) : a.mass;
  const ContactLaw& law = laws.of(a.material, b ? b->material : scene.boundaries[s.other].material);
  const double overlap = 2 * std::min(ra, rb) * s.depth;
  return std::sqrt(2 * elastic_energy(laws, law, radius, overlap, {}) / mass);
}

}  // namespace

void check_start(const Scene& scene) {
  const InitialOverlap s = deepest_overlap(scene);
  if (s.depth <= 0) return;
  const double speed = parting_speed(scene, s);
  const double limit = scene.run.max_speed > 0 ? scene.run.max_speed : most_typical_speeds * typical_speed(scene);
  if (speed <= limit) return;
  throw InputError(fmt::format(
      "{}: element {} overlaps {} {} by {:.3g} % of its diameter at the start: engine soft_sphere would throw them "
      "apart "
      "at {:.3g} m/s, the limit is {:.3g} m/s (run.max_speed, or 10 times the speed at which elements are expected to "
      "meet); place elements apart or state a smaller normal_stiffness",
      scene.source, s.element, s.with_boundary ? "boundary" : "element", s.other, 100 * s.depth, speed, limit));
}

}  // namespace moraine::soft_sphere
