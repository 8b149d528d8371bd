// SPDX-License-Identifier: Apache-2.0
// Bonds: central springs and dashpots that break for good when too long.
#pragma once

#include "physics/soft_sphere/bodies.hpp"

namespace moraine::soft_sphere {

class BondSprings {
 public:
  struct Entry {
    std::uint32_t bond = 0;  ///< index into Scene::bonds
    Slot a = 0, b = 0;       ///< as the scene orders them
  };

  explicit BondSprings(const Scene& scene) : scene_(&scene) {}

  void add(std::uint32_t bond, Slot a, Slot b);
  void remove(std::uint32_t bond);
  void clear() { entries_.clear(); }

  /// Drops the bonds that are longer at the start of a step than they may be.
  void break_long(const Bodies& bodies);
  std::span<const std::uint32_t> broken() const { return broken_; }
  /// Adds all forces to the loads, in the order of the scene's bonds.
  void act(Bodies& bodies) const;
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  const Scene* scene_;
  std::vector<Entry> entries_;  ///< ascending bond
  std::vector<std::uint32_t> broken_;
};

}  // namespace moraine::soft_sphere
