// SPDX-License-Identifier: Apache-2.0
// Bonds: central springs and dashpots as soft constraints, that break for good when too long.
#pragma once

#include "physics/impulse/bodies.hpp"

namespace moraine::impulse {

class Bonds {
 public:
  struct Entry {
    std::uint32_t bond = 0;  ///< index into Scene::bonds
    Slot a = 0, b = 0;
    float impulse = 0;  ///< of the last step, pulling together
  };

  Bonds(const Scene& scene, const Units& units) : scene_(&scene), units_(units) {}

  void add(const Entry& entry);
  void remove(std::uint32_t bond);
  void clear() { entries_.clear(); }
  std::span<const Entry> entries() const { return entries_; }

  /// Drops the bonds that are too long at the start of a step.
  void break_long(const Bodies& bodies);
  std::span<const std::uint32_t> broken() const { return broken_; }

  // As PairContacts.
  void gather(const Bodies& bodies, float h);
  void warm_start(Moving* bodies) const;
  void sweep(Moving* bodies);
  void keep_impulses();

 private:
  struct Row {
    Vec axis;  ///< from b to a
    Place a = 0, b = 0;
    float inverse_mass_a = 0, inverse_mass_b = 0;
    float pull = 0;  ///< impulse at the length at the start of the step
    float drag = 0;  ///< and per parting speed
    float impulse = 0;
  };
  static void apply(const Row& row, Moving* bodies, float impulse);
  Row row(const Entry& entry, const Bodies& bodies, float h) const;
  Vec between(const Entry& entry, const Bodies& bodies) const;

  const Scene* scene_;
  const Units& units_;
  std::vector<Entry> entries_;  ///< ascending bond
  std::vector<Row> rows_;
  std::vector<std::uint32_t> broken_;
};

}  // namespace moraine::impulse
