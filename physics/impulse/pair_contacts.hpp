// SPDX-License-Identifier: Apache-2.0
// Contacts between two balls.
#pragma once

#include "physics/impulse/bodies.hpp"
#include "physics/impulse/step_rule.hpp"
#include "physics/native/verlet_list.hpp"

namespace moraine::impulse {

struct PairRow : ContactRow {
  Place a = 0, b = 0;  ///< a < b
  float inverse_mass_a = 0, inverse_mass_b = 0;
};

/// Rows are gathered from the list anew in every step, in its order, and take up what their pair's row of the step
/// before holds. So results do not depend on when the list was made.
class PairContacts {
 public:
  explicit PairContacts(const StepRule& rule) : rule_(rule) {}

  void list(const native::SizedGrid& grid, std::span<const native::Ball> balls, std::span<const std::uint8_t> passive,
            double skin) {
    pairs_.build(grid, balls, passive, skin);
  }
  /// Bodies have new places.
  void follow(std::span<const Place> moved);

  /// Rows of all pairs that may meet in this step, from the velocities at its start. Cost: linear in listed pairs.
  void gather(const Bodies& bodies);
  void warm_start(Moving* bodies) const;
  void sweep(Moving* bodies);
  /// Bodies have moved by their velocities over the step: what remains is to part with the right speed. Those that met
  /// in the step do so along the line on which they touch: that keeps angular momentum.
  void relax(const Bodies& bodies);

  std::span<const PairRow> rows() const { return {rows_.data(), count_}; }
  void restore(std::vector<PairRow> rows);

 private:
  template <bool Friction>
  void sweep_all(Moving* bodies);
  void find_close(const Bodies& bodies);
  bool fill(const Bodies& bodies, std::size_t pair, PairRow& row) const;
  void take_up_impulses();
  void put_in_order();

  const StepRule& rule_;
  native::VerletList pairs_;
  std::vector<PairRow> rows_, before_;  ///< ascending (a, b); the first count_ and count_before_ are in use
  std::size_t count_ = 0, count_before_ = 0;
  std::vector<std::uint32_t> close_;                     ///< pairs within reach
  std::vector<std::uint32_t> rank_, order_, order_end_;  ///< in which rows are solved
};

}  // namespace moraine::impulse
