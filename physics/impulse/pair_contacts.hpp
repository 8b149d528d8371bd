// SPDX-License-Identifier: Apache-2.0
// Contacts between two balls.
#pragma once

#include "physics/impulse/bodies.hpp"
#include "physics/impulse/pair_kernels.hpp"
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
  void warm_start(Bodies& bodies) { kernels_.warm_start(task(bodies)); }
  void sweep(Bodies& bodies) { kernels_.sweep(task(bodies)); }
  /// The last sweep, after bodies have moved by their velocities over the step. Completes rows().
  void relax(Bodies& bodies);

  std::span<const PairRow> rows() const { return {rows_.data(), count_}; }
  void restore(std::vector<PairRow> rows);

 private:
  PairTask task(Bodies& bodies);
  void find_close(const Bodies& bodies);
  void place_close(const Bodies& bodies);
  bool fill(const Bodies& bodies, std::size_t close, PairRow& row) const;
  void take_up_impulses();
  void choose_colours(std::size_t bodies);
  void fill_batches();
  void keep_impulses();

  const StepRule& rule_;
  native::VerletList pairs_;
  std::vector<PairRow> rows_, before_;  ///< ascending (a, b); the first count_ and count_before_ are in use
  std::size_t count_ = 0, count_before_ = 0;
  std::vector<std::uint32_t> close_;          ///< pairs within reach
  std::vector<PairPlacing> placing_;          ///< of those
  std::vector<std::uint32_t> meeting_;        ///< those of them that may meet, as places in close_
  std::vector<std::uint64_t> taken_;          ///< by body: colours of its rows, as bits
  std::vector<std::uint8_t> colour_;          ///< by row
  std::vector<std::uint32_t> colour_rows_;    ///< rows of each colour
  std::vector<std::uint32_t> colour_cursor_;  ///< lane that the next row of each colour takes
  std::vector<PairBatch> batches_;            ///< in the order in which they are solved
  const PairKernels& kernels_ = pair_kernels();
};

}  // namespace moraine::impulse
