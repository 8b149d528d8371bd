// SPDX-License-Identifier: Apache-2.0
// A whole engine in little: balls that springs push apart. docs/engines.md goes through it.
#pragma once

#include "ghosting/model.hpp"
#include "physics/native/roster.hpp"
#include "physics/native/verlet_list.hpp"
#include "physics/native/walls.hpp"

namespace moraine::test {

/// Frictionless balls; a contact is a spring and a critical dashpot. Semi-implicit Euler.
class SpringWorld final : public World {
 public:
  explicit SpringWorld(const WorldSettings& s) : s_(s), scene_(*s.scene), walls_(*s.scene) {}
  Slot add(const Body& b) override {
    if (const std::size_t count = roster_.count() + walls_.size() + 1; count > s_.limits.elements)
      throw InputError(fmt::format("engine spring: {} bodies, the limit is {}", count, s_.limits.elements));
    bodies_.push_back(b);
    return roster_.add(b.id);
  }
  void remove(Slot slot) override { roster_.remove(slot); }
  void set_state(Slot slot, const ElementState& state) override { bodies_[roster_.place(slot)].state = state; }
  ElementState state(Slot slot) const override { return bodies_[roster_.place(slot)].state; }
  void set_mass(Slot slot, double mass, bool) override { bodies_[roster_.place(slot)].mass = mass; }
  void apply_impulse(Slot slot, const Impulse& impulse) override {
    Body& b = bodies_[roster_.place(slot)];
    const double inertia = b.mass * scene_.shapes[b.shape].inertia_per_mass.x();
    b.state.twist += {impulse.linear / b.mass, impulse.angular / inertia};
  }

  /// Forces follow from the state at the start, so bodies_ may change while they are summed.
  void step(double t) override {
    canonicalise();
    contacts_.clear();
    given_ = {};
    work_ = 0;
    const std::vector<Body> start = bodies_;
    meet_walls(start, t);
    meet_each_other(start);
    for (Body& b : bodies_) {
      Twist& v = b.state.twist;
      v.linear += s_.substep * s_.gravity;
      b.state.pose.position += s_.substep * v.linear;
      if (const double angle = s_.substep * v.angular.norm(); angle > 0)
        b.state.pose.orientation = Eigen::AngleAxisd(angle, v.angular.normalized()) * b.state.pose.orientation;
    }
    std::stable_sort(contacts_.begin(), contacts_.end(), earlier);
  }

  Impulse boundary_impulse() const override { return given_; }
  double boundary_work() const override { return work_; }
  std::vector<Contact> contacts() const override { return contacts_; }
  StepWork work() const override { return {roster_.count(), contacts_.size(), 0}; }

  /// All in id order: nothing may depend on the order in which bodies came.
  void canonicalise() override {
    if (!roster_.unsettled()) return;
    roster_.settle();
    native::reorder(bodies_, roster_.order());
  }
  void save(std::vector<std::byte>& out) const override {
    ByteWriter w(out);
    w.put(magic);
    roster_.save(w);
    w.put_all(std::as_bytes(std::span(bodies_)));
  }
  void load(std::span<const std::byte> in) override {
    ByteReader r(in);
    if (r.get<std::uint32_t>() != magic) throw IoError("not a saved spring world");
    roster_.load(r);
    std::vector<std::byte> bodies;
    r.get_all(bodies);
    bodies_.resize(bodies.size() / sizeof(Body));
    std::memcpy(static_cast<void*>(bodies_.data()), bodies.data(), bodies.size());
  }

 private:
  static constexpr std::uint32_t magic = 0x50534d42U;
  void push(native::Place p, const Vec3& impulse) { bodies_[p].state.twist.linear += impulse / bodies_[p].mass; }
  void touch(Contact c, native::Place p, const Vec3& v, double inverse_mass) {
    const double k = 1e4 * s_.mass_unit / (s_.time_unit * s_.time_unit);
    c.impulse = s_.substep * (k * c.overlap - 2 * std::sqrt(k / inverse_mass) * c.normal.dot(v)) * c.normal;
    push(p, c.impulse);
    contacts_.push_back(c);
  }
  void meet_walls(std::span<const Body> start, double t) {
    balls_.clear();
    ghost_.clear();
    for (const Body& b : start) balls_.push_back({b.state.pose.position, scene_.shapes[b.shape].bounding_radius});
    for (const Body& b : start) ghost_.push_back(b.role == Role::ghost);
    grid_.build(balls_, 0);
    walls_.move(t);
    walls_.find(grid_, balls_, ghost_, 0, near_);
    for (std::size_t i = 0, end = 0; i < near_.size(); i = end) {
      const auto [p, wall, surface] = near_[i];
      while (end < near_.size() && near_[end].ball == p && near_[end].wall == wall) ++end;
      native::find_touches(walls_[wall], balls_[p], std::span(near_).subspan(i, end - i), nearest_);
      for (const native::Nearest& n : nearest_) {
        const Vec3 v = start[p].state.twist.linear - walls_[wall].velocity(n.point);
        touch({start[p].id, wall, true, n.point, n.normal, balls_[p].radius - n.distance, {}}, p, v, 1 / start[p].mass);
        given_ += {contacts_.back().impulse, n.point.cross(contacts_.back().impulse)};
        work_ += contacts_.back().impulse.dot(walls_[wall].velocity(n.point));
      }
    }
  }
  void meet_each_other(std::span<const Body> start) {
    pairs_.build(grid_, balls_, ghost_, 0);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const native::Place p = pairs_.lower()[k], q = pairs_.higher()[k];
      const Vec3 apart = balls_[p].centre - balls_[q].centre, n = apart.normalized();
      const Body &a = start[p], &b = start[q];
      const double overlap = balls_[p].radius + balls_[q].radius - apart.norm();
      touch({a.id, b.id, false, balls_[q].centre + balls_[q].radius * n, n, overlap, {}}, p,
            a.state.twist.linear - b.state.twist.linear, 1 / a.mass + 1 / b.mass);
      push(q, -contacts_.back().impulse);
    }
  }

  WorldSettings s_;
  const Scene& scene_;
  native::Roster roster_;
  native::Walls walls_;
  native::SizedGrid grid_;
  native::VerletList pairs_;
  std::vector<Body> bodies_;  ///< by place
  std::vector<native::Ball> balls_;
  std::vector<std::uint8_t> ghost_;
  std::vector<native::WallCandidate> near_;
  std::vector<native::Nearest> nearest_;
  std::vector<Contact> contacts_;
  Impulse given_;
  double work_ = 0;
};

/// Its row. In the largest substep twelve critical dashpots at once are stable.
inline Engine spring_engine() {
  Engine row{.name = "spring",
             .help = "an example: frictionless balls and springs",
             .precision = "float64",
             .supports = [](const Geometry& g) { return std::holds_alternative<Sphere>(g); },
             .relative_cost = [](double) { return 1.0; },
             .make = [](auto& s, auto&) -> std::unique_ptr<World> { return std::make_unique<SpringWorld>(s); },
             .bonds = false};
  row.step_limit = [](auto& s) { return StepLimit{0.001 * world_settings(s).time_unit, "its dashpots"}; };
  return row;
}

}  // namespace moraine::test
