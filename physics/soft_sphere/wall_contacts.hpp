// SPDX-License-Identifier: Apache-2.0
// Contacts of balls with boundaries.
#pragma once

#include "physics/native/walls.hpp"
#include "physics/soft_sphere/bodies.hpp"
#include "physics/soft_sphere/contact_force.hpp"

namespace moraine::soft_sphere {

/// A contact that lasts. A ball may touch one wall in several places; they are told apart by their normals.
struct LastingWallContact {
  Place ball = 0;
  std::uint32_t wall = 0;
  Vec3 normal = Vec3::UnitZ();
  Vec3 point = Vec3::Zero();
  double overlap = 0;
  Springs springs;
};

class WallContacts {
 public:
  WallContacts(const ContactLaws& laws, const Scene& scene) : laws_(laws), walls_(scene) {}

  native::Walls& walls() { return walls_; }
  const native::Walls& walls() const { return walls_; }
  void list(const native::SizedGrid& grid, const Bodies& bodies, double skin);

  /// Contacts of the last step, ascending by ball, then by wall.
  std::vector<LastingWallContact>& lasting() { return contacts_; }
  const std::vector<LastingWallContact>& lasting() const { return contacts_; }

  /// Adds all forces to the loads, each ball's in the order of the walls, and advances the springs by h.
  void act(Bodies& bodies, double h);
  /// Given to the balls in the last step, angular part about the world origin.
  const Impulse& impulse() const { return impulse_; }
  /// Of driven walls in the last step [J].
  double work() const { return work_; }
  /// Elastic energy at the end of the last step of h seconds [J].
  double energy(const Bodies& bodies, double h) const;
  /// The push of a contact of the last step, with the velocities of now.
  Push push_of(const Bodies& bodies, const LastingWallContact& contact) const;

 private:
  using Group = std::span<const native::WallCandidate>;
  template <class Uses>
  void act_on(Bodies& bodies, Group group, double h);
  Meeting meet(const Bodies& bodies, const LastingWallContact& contact) const;
  Springs earlier(const LastingWallContact& contact) const;

  const ContactLaws& laws_;
  native::Walls walls_;
  std::vector<native::WallCandidate> candidates_;
  std::vector<LastingWallContact> contacts_, before_;
  std::size_t passed_ = 0;  ///< of `before_`: those of earlier balls and walls
  std::vector<native::Nearest> touches_;
  Impulse impulse_;
  double work_ = 0;
};

}  // namespace moraine::soft_sphere
