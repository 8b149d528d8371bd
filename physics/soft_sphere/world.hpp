// SPDX-License-Identifier: Apache-2.0
// The soft-sphere engine behind the world contract: explicit discrete element method (Cundall & Strack 1979), doubles.
#pragma once

#include <vector>

#include "physics/soft_sphere/bond_springs.hpp"
#include "physics/soft_sphere/pair_contacts.hpp"
#include "physics/soft_sphere/wall_contacts.hpp"
#include "physics/world.hpp"

namespace moraine::soft_sphere {

/// A substep h is one step of the Verlet scheme in its drift-kick-drift form (position Verlet; Tuckerman, Berne &
/// Martyna 1992): x += h/2 v; v += h a(x, v); x += h/2 v. It goes through the same positions and half-step velocities
/// as velocity Verlet, needs one evaluation of the forces, and these depend on the state at the start of the substep
/// alone. Positions are absolute; every body sums contacts in id order, then bonds, then boundaries. So a body's path
/// has the same bits in every world that holds what it touches.
class SoftSphereWorld final : public World {
 public:
  explicit SoftSphereWorld(const WorldSettings& settings);

  Slot add(const Body& body) override;
  void remove(Slot slot) override { bodies_.remove(slot); }
  void set_state(Slot slot, const ElementState& state) override { bodies_.set_state(bodies_.place(slot), state); }
  ElementState state(Slot slot) const override { return bodies_.state(bodies_.place(slot)); }
  Vec3 position(Slot slot) const override { return bodies_.position[bodies_.place(slot)]; }
  void motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const override;
  void set_mass(Slot slot, double mass, bool) override { bodies_.set_mass(bodies_.place(slot), mass); }
  void apply_impulse(Slot slot, const Impulse& impulse) override;

  void add_bond(std::uint32_t bond, Slot a, Slot b) override;
  void remove_bond(std::uint32_t bond) override { bonds_.remove(bond); }
  std::span<const std::uint32_t> broken_bonds() const override { return bonds_.broken(); }

  void step(double t) override;

  Impulse boundary_impulse() const override { return walls_.impulse(); }
  double boundary_work() const override { return walls_.work(); }
  double contact_energy() const override;
  /// Places are those of the last step, in the middle of it; impulses are worked out with the velocities at its end.
  std::vector<Contact> contacts() const override;
  StepWork work() const override;

  std::vector<ContactMemory> contact_memory() const override;
  void remember(std::span<const ContactMemory> memory) override;

  void canonicalise() override { settle(); }
  void save(std::vector<std::byte>& out) const override;
  void load(std::span<const std::byte> in) override;

 private:
  void settle();
  void drift_half();
  void list_anew();
  void recall();
  void kick_and_drift();
  bool moved_too_far() const;

  WorldSettings settings_;
  ContactLaws laws_;
  double skin_ = 0;  ///< of the lists [m]
  Bodies bodies_;
  PairContacts pairs_;
  WallContacts walls_;
  BondSprings bonds_;

  native::SizedGrid grid_;
  std::vector<Vec3> listed_at_;  ///< positions when the lists were made
  bool listed_ = false;
  std::vector<LastingPair> lasting_;   ///< pairs to go on with when the lists are made anew
  std::vector<ContactMemory> memory_;  ///< of contacts elsewhere that may go on here, until the next step
};

}  // namespace moraine::soft_sphere
