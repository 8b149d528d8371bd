// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace moraine {
namespace {

using std::numbers::pi;

/// Time at full speed that covers what the ramp of a motion has covered `t` after it began to rise [s].
double risen(double t, double ramp) { return 0.5 * (t - ramp / pi * std::sin(pi * t / ramp)); }

/// Time at full speed that covers the distance travelled until t [s].
double travelled(const Motion& m, double t) {
  const double since = std::min(t, m.stop) - m.start;
  if (since <= 0) return 0;
  if (m.ramp <= 0) return since;
  if (since < m.ramp) return risen(since, m.ramp);
  const double left = m.stop - m.start - since;
  if (left < m.ramp) return m.stop - m.start - m.ramp - risen(left, m.ramp);
  return since - 0.5 * m.ramp;
}

/// Part of the full speed at time t, 0 .. 1.
double speed(const Motion& m, double t) {
  if (t < m.start || t >= m.stop) return 0;
  const double edge = std::min(t - m.start, m.stop - t);
  return edge < m.ramp ? 0.5 * (1 - std::cos(pi * edge / m.ramp)) : 1;
}

}  // namespace

bool MaterialTable::any_friction() const {
  return std::any_of(pairs.begin(), pairs.end(), [](const PairLaw& p) { return p.friction > 0; });
}

bool MaterialTable::any_restitution() const {
  return std::any_of(pairs.begin(), pairs.end(), [](const PairLaw& p) { return p.restitution > 0; });
}

Pose Motion::pose(const Pose& initial, double t) const {
  const double covered = travelled(*this, t);
  const double rate = velocity.angular.norm();
  Pose now = initial;
  if (rate > 0) {
    const Quat turn(Eigen::AngleAxisd(rate * covered, velocity.angular / rate));
    now.position = centre + turn * (initial.position - centre);
    now.orientation = (turn * initial.orientation).normalized();
  }
  now.position += velocity.linear * covered;
  return now;
}

Twist Motion::twist(const Pose& initial, double t) const {
  const double part = speed(*this, t);
  const Vec3 moved_centre = centre + velocity.linear * travelled(*this, t);
  const Vec3 arm = pose(initial, t).position - moved_centre;
  return {part * (velocity.linear + velocity.angular.cross(arm)), part * velocity.angular};
}

double Scene::typical_diameter() const {
  if (elements.empty()) return 1;
  double sum = 0;
  for (const Element& e : elements) sum += 2 * shape_of(e).bounding_radius;
  return sum / static_cast<double>(elements.size());
}

double Scene::typical_mass() const {
  if (elements.empty()) return 1;
  double sum = 0;
  for (const Element& e : elements) sum += e.mass;
  return sum / static_cast<double>(elements.size());
}

}  // namespace moraine
