// SPDX-License-Identifier: Apache-2.0
// The impulse engine behind the world contract: sequential impulses for spheres, float32.
#pragma once

#include <vector>

#include "physics/impulse/bonds.hpp"
#include "physics/impulse/drift.hpp"
#include "physics/impulse/pair_contacts.hpp"
#include "physics/impulse/wall_contacts.hpp"
#include "physics/world.hpp"

namespace moraine::impulse {

/// A step (Catto, "Solver2D" 2024, there a sub-step of "soft step"): gravity; last step's impulses; sweeps over all
/// rows with soft contacts; positions; relaxing sweeps that take back the speed with which overlaps were removed, and
/// in which impacts rebound. Catto relaxes once; here half of all sweeps relax, for those decide which velocities
/// remain. Order: bonds, pairs by colour, boundaries.
class ImpulseWorld final : public World {
 public:
  ImpulseWorld(const WorldSettings& settings, const Vec3& origin);

  Slot add(const Body& body) override;
  void remove(Slot slot) override { bodies_.roster.remove(slot); }
  void set_state(Slot slot, const ElementState& state) override;
  ElementState state(Slot slot) const override { return bodies_.state(bodies_.place(slot)); }
  Vec3 position(Slot slot) const override { return units_.position(bodies_.position[bodies_.place(slot)]); }
  void motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const override;
  void set_mass(Slot slot, double mass, bool carries) override { bodies_.set_mass(bodies_.place(slot), mass, carries); }
  void apply_impulse(Slot slot, const Impulse& impulse) override;

  void add_bond(std::uint32_t bond, Slot a, Slot b) override { bonds_.add({bond, a, b, 0}); }
  void remove_bond(std::uint32_t bond) override { bonds_.remove(bond); }
  std::span<const std::uint32_t> broken_bonds() const override { return bonds_.broken(); }

  void step(double t) override;

  Impulse boundary_impulse() const override { return walls_.impulse(); }
  double boundary_work() const override { return walls_.work(); }
  std::vector<Contact> contacts() const override;
  /// Pairs, then boundaries: without a list of all, which would be larger than the world.
  void each_contact(const std::function<void(const Contact&)>& visit) const override;
  StepWork work() const override;

  void canonicalise() override { settle(); }
  void save(std::vector<std::byte>& out) const override;
  void load(std::span<const std::byte> in) override;

 private:
  void settle();
  void admit(std::size_t before);
  void drop_lists();
  void keep_lists();
  bool walls_may_be_near(float way) const;
  bool pairs_may_be_near(float way);
  float farthest_way() const;
  void list_pairs();
  void list_walls();
  float suitable_skin() const;
  void gather();
  void warm_start();
  void sweep();
  void relax();
  Contact contact(const PairRow& row) const;
  Contact contact(const WallRow& row) const;

  WorldSettings settings_;
  Units units_;
  StepRule rule_;
  Bodies bodies_;
  PairContacts pairs_;
  WallContacts walls_;
  Bonds bonds_;
  bool turns_ = false;  ///< some body may turn

  std::vector<Vec> listed_at_;  ///< positions to which the list of pairs refers
  Drift drift_;
  std::vector<Place> newcomers_;
  float skin_ = 0, wall_skin_ = 0;  ///< of the lists of pairs and walls
  float gone_ = 0;                  ///< how far bodies may have moved from the list of walls to that of pairs
  bool listed_ = false;
};

}  // namespace moraine::impulse
