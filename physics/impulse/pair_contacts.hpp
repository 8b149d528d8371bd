// SPDX-License-Identifier: Apache-2.0
// Contacts between two balls.
#pragma once

#include <array>

#include "physics/impulse/batch_store.hpp"
#include "physics/impulse/bodies.hpp"
#include "physics/impulse/carried_impulses.hpp"
#include "physics/impulse/near_list.hpp"
#include "physics/impulse/pair_kernels.hpp"
#include "physics/impulse/step_rule.hpp"
#include "physics/native/room.hpp"

namespace moraine::impulse {

/// A contact of the last step, as others see it.
struct PairRow {
  Vec normal = Vec::Zero();  ///< unit, towards a
  Vec side = Vec::Zero();    ///< tangential impulse on a
  Place a = 0, b = 0;        ///< a < b
  float push = 0;            ///< normal impulse on a
  float rebound = 0;         ///< speed after an impact, else 0
};

/// Contacts are chosen from the list anew in every step, in its order, and take up what their pair carried in the step
/// before. So results do not depend on when the list was made.
class PairContacts {
 public:
  explicit PairContacts(const StepRule& rule) : rule_(rule) {}

  /// Lists all pairs that may meet while nothing moves farther than half of what the skin exceeds the reach by.
  void list(const Bodies& bodies, float skin);
  /// Bodies have new places.
  void follow(std::span<const Place> moved);
  /// Adds pairs of ghosts that have come since the list was made.
  void insert(const Bodies& bodies, std::span<const Place> ghosts);
  /// The next step lists anew.
  void drop_list() { listed_ = false; }

  /// Chooses all pairs that may meet in this step, from the velocities at its start. Cost: linear in listed pairs.
  void find(Bodies& bodies);
  /// Makes contacts of them and gives bodies the impulses of the step before.
  void start(Bodies& bodies);
  void sweep(Bodies& bodies) { solve(kernels_.sweep, bodies); }
  /// A sweep after bodies have moved by their velocities over the step. What contacts have after the last one they
  /// carry on to the next step.
  void relax(Bodies& bodies) { solve(kernels_.relax, bodies); }

  std::size_t count() const { return meeting_.count; }
  /// Of the last step, ascending (a, b).
  std::vector<PairRow> rows() const;
  template <class Visit>
  void each_row(Visit&& visit) const {
    for (const std::uint32_t lane : lanes()) visit(row(lane));
  }
  void restore(const Bodies& bodies, std::span<const PairRow> rows);

 private:
  /// A list that keeps its memory.
  struct Places {
    std::vector<std::uint32_t> at;
    std::size_t count = 0;
    /// Room for so many behind those that count.
    std::uint32_t* more(std::size_t room) {
      native::extend(at, count + room);
      return at.data() + count;
    }
    void add(std::uint32_t place) {
      if (count == at.size()) more(64);
      at[count++] = place;
    }
    std::span<const std::uint32_t> all() const { return {at.data(), count}; }
  };
  /// Colours of a body's contacts in a group, as bits.
  struct Taken {
    std::uint32_t group = 0, colours = 0;
  };
  static constexpr ElementId group_ids = 256;
  /// Contacts of the last colour may share bodies, and are solved one by one.
  static constexpr std::size_t colours = 32, crowded = colours - 1;

  std::vector<std::uint32_t> lanes() const;
  PairRow row(std::uint32_t lane) const;
  static BodyArrays arrays(Bodies& bodies);
  PairTable table() const;
  PairFeatures features() const { return {rule_.friction, rule_.restitution}; }
  PairLaws laws() const { return {rule_.constants().data(), rule_.materials()}; }
  static ElementId group_of(const Bodies& bodies, Place lower);
  void carry_on(ElementId group, std::span<const std::uint32_t> contacts);
  void choose_colours(std::span<const std::uint32_t> pairs, std::uint32_t group);
  void start_group(Bodies& bodies);
  void fill(PairStartTask& task, std::span<const std::uint32_t> pairs);
  void solve(void (*kernel)(const PairTask&), Bodies& bodies);

  const StepRule& rule_;
  NearList pairs_;
  bool listed_ = false;
  bool shifted_ = false;                  ///< pairs have other places in the list than in the step before
  Places meeting_;                        ///< pairs in contact in this step, ascending
  std::vector<Taken> taken_;              ///< by body
  std::array<Places, colours> coloured_;  ///< pairs of each colour
  BatchStore batches_;
  CarriedImpulses carried_;
  const PairKernels& kernels_ = pair_kernels();
};

}  // namespace moraine::impulse
