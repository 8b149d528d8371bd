// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/wall_contacts.hpp"

#include <utility>

namespace moraine::soft_sphere {
namespace {

/// Cosine of the angle by which a normal may turn in a step and still belong to the same contact: a ball that rolls
/// from one triangle of a mesh to the next keeps its spring.
constexpr double same_contact = 0.9;

template <class A, class B>
bool earlier_place(const A& a, const B& b) {
  return std::pair(a.ball, a.wall) < std::pair(b.ball, b.wall);
}

}  // namespace

void WallContacts::list(const native::SizedGrid& grid, const Bodies& bodies, double skin) {
  walls_.find(grid, bodies.ball, bodies.ghost, skin, candidates_);
}

void WallContacts::act(Bodies& bodies, double h) {
  impulse_ = {};
  work_ = 0;
  std::swap(contacts_, before_);
  contacts_.clear();
  passed_ = 0;
  with_parts(laws_, [&](auto parts) {
    for (std::size_t begin = 0, end = 0; begin < candidates_.size(); begin = end) {
      while (end < candidates_.size() && !earlier_place(candidates_[begin], candidates_[end])) ++end;
      act_on<decltype(parts)>(bodies, Group(candidates_).subspan(begin, end - begin), h);
    }
  });
}

/// The springs of the contact of the step before whose normal is nearest, or fresh ones.
Springs WallContacts::earlier(const LastingWallContact& contact) const {
  Springs best;
  double best_cosine = same_contact;
  for (std::size_t k = passed_; k < before_.size() && !earlier_place(contact, before_[k]); ++k) {
    const double cosine = before_[k].normal.dot(contact.normal);
    if (cosine <= best_cosine) continue;
    best_cosine = cosine;
    best = before_[k].springs;
  }
  return best;
}

Meeting WallContacts::meet(const Bodies& bodies, const LastingWallContact& c) const {
  const Moving& body = bodies.moving[c.ball];
  Meeting m;
  m.normal = c.normal;
  m.overlap = c.overlap;
  m.velocity = body.velocity - walls_[c.wall].velocity(c.point);
  m.radius = bodies.ball[c.ball].radius;
  m.turning = (m.radius - c.overlap) * body.spin;
  m.spin = body.spin - walls_[c.wall].spin();
  m.root_mass = 1 / std::sqrt(body.inverse_mass);
  return m;
}

template <class Uses>
void WallContacts::act_on(Bodies& bodies, Group group, double h) {
  const auto [place, index, surface] = group.front();
  const native::Wall& wall = walls_[index];
  const native::Ball& ball = bodies.ball[place];
  while (passed_ < before_.size() && earlier_place(before_[passed_], group.front())) ++passed_;
  native::find_touches(wall, ball, group, touches_);
  for (const native::Nearest& touch : touches_) {
    LastingWallContact c{place, index, touch.normal, touch.point, ball.radius - touch.distance, {}};
    c.springs = earlier(c);
    const Meeting m = meet(bodies, c);
    const Push p = push<Uses>(laws_.of(bodies.moving[place].material, wall.material()), m, h, c.springs);
    bodies.load[place].force += p.force;
    const Vec3 torque = touch.distance * p.moment + p.couple;
    bodies.load[place].torque += torque;
    impulse_ += {h * p.force, h * (ball.centre.cross(p.force) + torque)};
    if (wall.moves()) work_ += h * p.force.dot(wall.velocity(c.point));
    contacts_.push_back(c);
  }
}

/// Places are those in the middle of the step; half a step of closing is added.
double WallContacts::energy(const Bodies& bodies, double h) const {
  double sum = 0;
  for (const LastingWallContact& c : contacts_) {
    const Meeting m = meet(bodies, c);
    const double overlap = c.overlap - h / 2 * m.velocity.dot(m.normal);
    sum += elastic_energy(laws_, laws_.of(bodies.moving[c.ball].material, walls_[c.wall].material()), m.radius, overlap,
                          c.springs);
  }
  return sum;
}

Push WallContacts::push_of(const Bodies& bodies, const LastingWallContact& contact) const {
  Push out;
  with_parts(laws_, [&](auto parts) {
    Springs s = contact.springs;
    const ContactLaw& law = laws_.of(bodies.moving[contact.ball].material, walls_[contact.wall].material());
    out = push<decltype(parts)>(law, meet(bodies, contact), 0, s);
  });
  return out;
}

}  // namespace moraine::soft_sphere
