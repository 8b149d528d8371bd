// SPDX-License-Identifier: Apache-2.0
// Which bonds a world holds.
#pragma once

#include <vector>

#include "physics/ode/bodies.hpp"

namespace moraine::ode {

class Bonds {
 public:
  struct Entry {
    std::uint32_t bond = 0;  ///< index into Scene::bonds
    Slot a = 0, b = 0;
  };

  explicit Bonds(const Scene& scene) : scene_(scene) {}

  void add(const Entry& entry);
  void remove(std::uint32_t bond);
  void clear() { entries_.clear(); }
  const std::vector<Entry>& entries() const { return entries_; }

  /// Drops the bonds that are longer at the start of a step than they may be.
  void break_long(const Bodies& bodies);
  std::span<const std::uint32_t> broken() const { return broken_; }

  /// Makes a joint for each: ODE's distance joint, softened so that it is the
  /// bond's spring and dashpot, integrated implicitly (ODE manual, "How to use
  /// ERP and CFM").
  void make_joints(const Bodies& bodies, const Units& units, double h, dWorldID world, dJointGroupID group) const;

 private:
  const Scene& scene_;
  std::vector<Entry> entries_;  ///< ascending bond
  std::vector<std::uint32_t> broken_;
};

}  // namespace moraine::ode
