// SPDX-License-Identifier: Apache-2.0
// Contacts of balls with boundaries.
#pragma once

#include "physics/impulse/bodies.hpp"
#include "physics/impulse/step_rule.hpp"
#include "physics/native/walls.hpp"

namespace moraine::impulse {

/// A ball may touch one wall in several places; they are told apart by their normals.
struct WallRow : ContactRow {
  Vec velocity = Vec::Zero();  ///< of the wall's surface
  Place ball = 0;
  std::uint32_t wall = 0;
  float inverse_mass = 0;
  float unused = 0;  ///< up to the alignment, so that saved worlds hold no undefined bytes
};

class WallContacts {
 public:
  WallContacts(const StepRule& rule, const Units& units, const Scene& scene)
      : rule_(rule), units_(units), walls_(scene) {}

  native::Walls& walls() { return walls_; }
  const native::Walls& walls() const { return walls_; }
  void list(const native::SizedGrid& grid, std::span<const native::Ball> balls, std::span<const std::uint8_t> passive,
            double skin) {
    walls_.find(grid, balls, passive, skin, candidates_);
  }
  void follow(std::span<const Place> moved);

  // As PairContacts.
  void gather(const Bodies& bodies);
  void warm_start(Moving* bodies) const;
  void sweep(Moving* bodies);
  void relax();

  /// Ascending by ball, then by wall.
  std::span<const WallRow> rows() const { return rows_; }
  void restore(std::vector<WallRow> rows) { rows_ = std::move(rows); }
  /// Given to the balls in the last step, angular part about the world frame's origin.
  const Impulse& impulse() const { return impulse_; }
  /// Of driven walls in the last step [J].
  double work() const { return work_; }
  /// Sums it up, before bodies move on.
  void sum_impulse(const Bodies& bodies);

 private:
  using Group = std::span<const native::WallCandidate>;
  template <bool Friction>
  void sweep_all(Moving* bodies);
  void meet(const Bodies& bodies, Group group);
  void add(const Bodies& bodies, WallRow row, const native::Nearest& touch);
  float take_up(WallRow& row) const;

  const StepRule& rule_;
  const Units& units_;
  native::Walls walls_;
  std::vector<native::WallCandidate> candidates_;
  std::vector<native::Nearest> touches_;
  std::vector<WallRow> rows_, before_;
  std::size_t passed_ = 0;  ///< of `before_`: those of earlier balls and walls
  Impulse impulse_;
  double work_ = 0;
};

}  // namespace moraine::impulse
