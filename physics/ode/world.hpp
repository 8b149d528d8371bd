// SPDX-License-Identifier: Apache-2.0
// ODE behind the world contract.
#pragma once

#include <memory>
#include <vector>

#include "physics/native/verlet_list.hpp"
#include "physics/ode/bonds.hpp"
#include "physics/ode/walls.hpp"
#include "physics/world.hpp"

namespace moraine::ode {

/// ODE's world, with what it shares with no other: memory for stepping, and the
/// threading in which there is one thread.
class Dynamics {
 public:
  Dynamics(const WorldSettings& settings, const Units& units);
  Dynamics(const Dynamics&) = delete;
  Dynamics& operator=(const Dynamics&) = delete;
  ~Dynamics();

  dWorldID world() const { return world_; }
  dJointGroupID joints() const { return joints_; }
  /// With the joints there are, which end with it.
  void step(double h);

 private:
  dWorldID world_;
  dJointGroupID joints_;
  dThreadingImplementationID threading_;
  bool stepping_ = false;
};

/// ODE remembers nothing from step to step: bodies are told their states and
/// all joints are made anew, in id order. What a step does follows from the
/// states at its start.
class OdeWorld final : public World {
 public:
  OdeWorld(const WorldSettings& settings, const Vec3& origin);

  Slot add(const Body& body) override;
  void remove(Slot slot) override { bodies_.roster.remove(slot); }
  void set_state(Slot slot, const ElementState& state) override { bodies_.set_state(bodies_.place(slot), state); }
  ElementState state(Slot slot) const override { return bodies_.state(bodies_.place(slot)); }
  Vec3 position(Slot slot) const override { return bodies_.position(bodies_.place(slot)); }
  void motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const override;
  void set_mass(Slot slot, double mass, bool) override {
    bodies_.records[bodies_.place(slot)].mass = mass / units_.mass;
  }
  void apply_impulse(Slot slot, const Impulse& impulse) override { bodies_.push(bodies_.place(slot), impulse); }

  void add_bond(std::uint32_t bond, Slot a, Slot b) override { bonds_.add({bond, a, b}); }
  void remove_bond(std::uint32_t bond) override { bonds_.remove(bond); }
  std::span<const std::uint32_t> broken_bonds() const override { return bonds_.broken(); }

  void step(double t) override;

  Impulse boundary_impulse() const override { return boundary_impulse_; }
  double boundary_work() const override { return boundary_work_; }
  std::vector<Contact> contacts() const override;
  StepWork work() const override { return {bodies_.roster.count(), touches_.size(), bonds_.entries().size()}; }

  void canonicalise() override { settle(); }
  void save(std::vector<std::byte>& out) const override;
  void load(std::span<const std::byte> in) override;

 private:
  void settle();
  bool moved_too_far() const;
  void list_anew();
  void find_touches();
  void make_contact(const Touch& touch, dJointFeedback& feedback);
  dSurfaceParameters surface(const Touch& touch) const;
  void sum_boundary_impulse();
  Contact contact(std::size_t touch) const;

  WorldSettings settings_;
  Units units_;
  double h_;  ///< a substep in scaled time
  Dynamics dynamics_;
  Bodies bodies_;
  WallTouches walls_;
  Bonds bonds_;

  std::vector<Touch> touches_;            ///< of the last step
  std::vector<dJointFeedback> feedback_;  ///< what each of them did
  Impulse boundary_impulse_;
  double boundary_work_ = 0;

  native::SizedGrid grid_;
  native::VerletList pairs_;
  std::vector<native::Ball> listed_;
  bool stale_ = true;
};

}  // namespace moraine::ode
