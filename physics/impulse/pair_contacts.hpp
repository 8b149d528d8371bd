// SPDX-License-Identifier: Apache-2.0
// Contacts between two balls.
#pragma once

#include <array>

#include "physics/impulse/bodies.hpp"
#include "physics/impulse/near_list.hpp"
#include "physics/impulse/pair_kernels.hpp"
#include "physics/impulse/step_rule.hpp"

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
  void drop_list();

  /// Chooses all pairs that may meet in this step, from the velocities at its start. Cost: linear in listed pairs.
  void find(Bodies& bodies);
  /// Makes contacts of them and gives bodies the impulses of the step before.
  void start(Bodies& bodies);
  void sweep(Bodies& bodies) { kernels_.sweep(task(bodies)); }
  /// A sweep after bodies have moved by their velocities over the step. What contacts have after the last one they
  /// carry on to the next step.
  void relax(Bodies& bodies, bool last);

  std::size_t count() const { return meeting_.count; }
  /// Of the last step, ascending (a, b).
  std::vector<PairRow> rows() const;
  template <class Visit>
  void each_row(Visit&& visit) const {
    for (const std::uint32_t lane : lanes()) visit(row(lane));
  }
  void restore(std::span<const PairRow> rows);

 private:
  /// A list that keeps its memory.
  struct Places {
    std::vector<std::uint32_t> at;
    std::size_t count = 0;
    /// Room for so many behind those that count.
    std::uint32_t* more(std::size_t room) {
      if (at.size() < count + room) at.resize(count + count / 4 + room);
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
  PairTable table();
  PairFeatures features() const { return {rule_.friction, rule_.restitution}; }
  PairLaws laws() const { return {rule_.constants().data(), rule_.materials()}; }
  PairTask task(Bodies& bodies);
  ElementId group_of(const Bodies& bodies, std::uint32_t pair) const;
  void make_room(std::size_t full);
  void choose_colours(std::span<const std::uint32_t> pairs, std::uint32_t group);
  void start_group(Bodies& bodies);
  void follow_list(std::span<const Place> moved);
  void follow_away(std::span<const Place> moved);
  void put_away();
  void take_out();
  void spread_carried();

  const StepRule& rule_;
  NearList pairs_;
  bool listed_ = false;
  std::vector<std::array<float, 4>> carried_;  ///< by place in the list, as in PairTable; zeros without contact
  std::vector<NearList::Pair> away_;      ///< while there is no list: pairs that carry the first of these, ascending
  Places meeting_, met_;                  ///< pairs in contact in this step and the one before, ascending
  std::vector<Taken> taken_;              ///< by body
  std::array<Places, colours> coloured_;  ///< pairs of each colour
  std::vector<PairBatch> batches_;        ///< in the order in which they are solved; the first count are in use
  std::size_t batch_count_ = 0;
  const PairKernels& kernels_ = pair_kernels();
};

}  // namespace moraine::impulse
