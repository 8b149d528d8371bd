// SPDX-License-Identifier: Apache-2.0
// The Bullet engine behind the world contract.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "physics/bullet/dynamics.hpp"
#include "physics/bullet/shapes.hpp"
#include "physics/bullet/sphere_contact.hpp"
#include "physics/bullet/units.hpp"
#include "physics/bytes.hpp"
#include "physics/world.hpp"

namespace moraine::bullet {

class BulletWorld final : public World {
 public:
  BulletWorld(const WorldSettings& settings, const Vec3& origin);
  ~BulletWorld() override;

  Slot add(const Body& body) override;
  void remove(Slot slot) override;
  void set_state(Slot slot, const ElementState& state) override;
  ElementState state(Slot slot) const override;
  Vec3 position(Slot slot) const override;
  void motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const override;
  void set_mass(Slot slot, double mass, bool carries) override;
  void apply_impulse(Slot slot, const Impulse& impulse) override;

  void add_bond(std::uint32_t bond, Slot a, Slot b) override;
  void remove_bond(std::uint32_t bond) override { bonds_.remove(bond); }
  std::span<const std::uint32_t> broken_bonds() const override { return bonds_.broken(); }

  void step(double t) override;

  Impulse boundary_impulse() const override { return boundary_impulse_; }
  double boundary_work() const override { return boundary_work_; }
  std::vector<Contact> contacts() const override;
  StepWork work() const override;

  void canonicalise() override;
  void save(std::vector<std::byte>& out) const override;
  void load(std::span<const std::byte> in) override;

 private:
  struct Entry {
    std::unique_ptr<btRigidBody> body;  ///< null: the slot is free
    BodyTag tag;
    std::uint32_t shape = 0;
    Role role = Role::real;
    double mass = 0;  ///< SI
  };

  Entry& entry(Slot slot) { return *entries_[slot]; }
  const Entry& entry(Slot slot) const { return *entries_[slot]; }
  Slot free_slot();
  void place(Slot slot, const Body& body);
  void check_limits() const;
  btCollisionShape* shape(std::uint32_t index);
  btVector3 inertia(std::uint32_t shape, double mass) const;
  void add_boundaries();
  void move_boundaries(double t);
  Pose boundary_pose(const Boundary& boundary, double t) const;
  void sum_boundary_impulse();
  Vec3 boundary_velocity(std::size_t boundary, const Vec3& point) const;
  void use_pair_laws() const;
  void clear();
  Slot slot_of(const btRigidBody* body) const { return static_cast<Slot>(body->getUserIndex()); }
  void save_contacts(ByteWriter& w) const;
  void save_bonds(ByteWriter& w) const;
  void load_contacts(ByteReader& r);
  void load_bonds(ByteReader& r);
  btPersistentManifold& make_manifold(btBroadphasePair& pair);
  Contact contact(const btPersistentManifold& manifold, const btManifoldPoint& point) const;

  WorldSettings settings_;
  Units units_;
  // Bullet points at these, so they outlive what follows.
  std::unordered_map<std::uint32_t, OwnedShape> shapes_;
  std::vector<std::unique_ptr<Entry>> entries_;  ///< by slot; addresses are stable, Bullet points at the tags
  std::vector<Slot> free_slots_;
  std::vector<OwnedShape> boundary_shapes_;
  std::vector<std::unique_ptr<Entry>> boundaries_;

  std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
  btCollisionDispatcher dispatcher_;
  SphereContact::Maker sphere_contacts_;
  mutable Broadphase broadphase_;
  Bonds bonds_;
  Dynamics dynamics_;

  double time_ = 0;  ///< at the start of the last step [s]: where driven boundaries stand
  Impulse boundary_impulse_;
  double boundary_work_ = 0;
  std::size_t bodies_ = 0;
};

}  // namespace moraine::bullet
