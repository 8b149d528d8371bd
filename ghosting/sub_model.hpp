// SPDX-License-Identifier: Apache-2.0
// One sub-model: an engine's world with the elements it owns, the ghosts it hosts, and its side of the coupling.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "ghosting/coupling.hpp"
#include "ghosting/enclosure.hpp"
#include "ghosting/ledger.hpp"
#include "ghosting/messages.hpp"
#include "ghosting/report.hpp"
#include "ghosting/rest.hpp"
#include "physics/cell_grid.hpp"
#include "physics/initial_overlap.hpp"
#include "physics/world.hpp"
#include "runtime/sub_model.hpp"

namespace moraine {

/// What all sub-models of a model share, read-only while it runs.
struct ModelContext {
  const Scene* scene = nullptr;
  std::vector<std::array<std::uint32_t, 2>> bond_ends;  ///< element indices of every scene bond
  const Engine* engine = nullptr;
  const Coupling* coupling = nullptr;
  WorldSettings world;
  double skin = 0;                   ///< ghosts are made below this gap [m]
  double speed_limit = 0;            ///< runaway above this [m/s]
  InitialOverlap start;              ///< the deepest
  StepLimit advised;                 ///< up to which the engine is at its best
  Enclosure enclosure;               ///< stands still during an epoch
  std::vector<double> inner_radius;  ///< by shape [m]
  double least_inner_radius = 0;
  RestLimits rest;
  DrivenBoundaries driven;
  /// Ghosts show their owner's state and have no say.
  bool followers() const { return engine->ghosts == GhostKind::follower; }
  double element_mass(std::uint32_t element) const { return scene->elements[element].mass; }
  double radius(std::uint32_t element) const { return scene->shapes[scene->elements[element].shape].bounding_radius; }
};

/// A bond between an element of this sub-model and one of another.
struct CrossBond {
  std::uint32_t bond = 0;   ///< index into Scene::bonds
  std::uint32_t own = 0;    ///< element here
  std::uint32_t other = 0;  ///< element there
};

/// A ghost in this world.
struct Ghost {
  std::uint32_t element = 0;
  Slot slot = 0;
  ElementState start;  ///< as the world holds it at the start of the substep
};

/// This sub-model hosts ghosts of `owner`'s elements.
struct HostLink {
  SubModelId owner = 0;
  Bounds bounds;  ///< of the owner's elements, a substep old
  double max_speed = 0;
  bool owner_rests = false;
  std::vector<Ghost> ghosts;        ///< ascending element
  std::vector<CrossBond> bonds;     ///< alive; other = the ghost
  std::vector<std::uint32_t> held;  ///< bonds of these that are in the world, ascending
};

/// `host` has ghosts of this sub-model's elements.
struct OwnerLink {
  SubModelId host = 0;
  bool border_is_new = false;          ///< the host asks for its ghosts to be chosen anew
  std::vector<BorderElement> border;   ///< the host's elements near our bounds
  std::vector<std::uint32_t> hosted;   ///< our elements that have a ghost there, ascending
  std::vector<std::uint32_t> shared;   ///< places of these among the shared elements
  std::vector<CrossBond> bonds;        ///< alive; own = the element that needs a ghost there
  std::vector<std::uint32_t> meeting;  ///< our elements that touch something there, or are about to, ascending
  std::vector<GhostResult> results;    ///< of the last step; at rest, of the last before it
};

class SubModel final : public runtime::SubModel {
 public:
  enum Stage : int { ghost_build_stage, step_stage, force_mirror_stage, bound_update_stage };
  static std::span<const runtime::Stage> stages();
  static std::span<const std::string_view> counters();

  /// `members`: elements ascending; `states`: one each. Bonds among them are `inner_bonds` (indices into Scene::bonds).
  /// `memory`: of contacts of the members.
  SubModel(const ModelContext& context, SubModelId id, std::vector<std::uint32_t> members,
           std::span<const ElementState> states, std::span<const std::uint32_t> inner_bonds,
           std::span<const ContactMemory> memory);
  /// Empty, to be loaded.
  SubModel(const ModelContext& context, SubModelId id) : SubModel(context, id, {}, {}, {}, {}) {}

  std::span<const runtime::SubModelId> sources(int stage) const override;
  std::span<const runtime::SubModelId> targets(int stage) const override;
  void run(int stage, const runtime::Round& round, runtime::Port& port) override;
  double counted_work(int stage) const override;
  void count(std::span<std::uint32_t> out) const override;
  double memory() const override;
  void save(std::vector<std::byte>& out) const override;
  void load(std::span<const std::byte> in) override;

  /// Sets the neighbours for the coming epoch; links to others are dissolved, ghosts and shares with them.
  struct Neighbour {
    SubModelId id;
    Bounds bounds;
    double max_speed;
    std::vector<CrossBond> bonds;
  };
  void set_neighbours(std::span<const Neighbour> neighbours);
  /// The epoch was only interrupted: the next opening round repeats what neighbours were told last, and changes
  /// nothing.
  void go_on() { interrupted_ = true; }
  /// Called between epochs in every sub-model alike.
  void canonicalise() { world_->canonicalise(); }

  SubModelId id() const { return id_; }
  std::span<const std::uint32_t> members() const { return members_; }
  std::size_t ghost_count() const;
  Report report() const;
  /// The accounts, with what the members have now.
  Ledger ledger() const;
  const World& world() const { return *world_; }
  bool resting() const { return resting_; }
  std::span<const HostLink> host_links() const { return host_links_; }
  std::span<const OwnerLink> owner_links() const { return owner_links_; }
  std::span<const SharedElement> shared() const { return shared_; }
  /// The canonical state of a member, by its place in members().
  ElementState state(std::size_t member) const;

 private:
  void ghost_build(const runtime::Round& round, runtime::Port& port);
  void build(const runtime::Port& port);
  void update_ghosts(HostLink& link, const BoundMessage& message);
  void place_ghost(Ghost& ghost, const GhostOrder& order, bool fresh);
  void drop_ghost(HostLink& link, const Ghost& ghost);
  void hold_bonds(HostLink& link);

  void step(const runtime::Round& round, runtime::Port& port);
  void advance(const runtime::Round& round);
  void read_motions();
  void note_broken(std::span<const std::uint32_t> bonds);
  bool borders_due(const runtime::Round& round);
  void report(const HostLink& link, bool opening, StepMessage& message) const;
  void report_border(const HostLink& link, std::vector<BorderElement>& border) const;
  GhostResult result(const Ghost& ghost) const;

  void force_mirror(const runtime::Round& round, runtime::Port& port);
  void receive_results(OwnerLink& link, std::span<const std::byte> bytes);
  void receive_border(OwnerLink& link);
  void forget_bonds(std::span<const std::uint32_t> broken);
  CopyMotion own_motion(const SharedElement& shared) const;
  void collect_motions(const SharedElement& shared);
  void combine(SharedElement& shared);
  Vec3 spin(std::size_t member) const;
  double stretch_energy(std::uint32_t bond, const Vec3& between) const;
  double bond_energy() const;
  Extremes extremes() const;
  void close_account();

  void bound_update(const runtime::Round& round, runtime::Port& port);
  void update_bounds();
  void check_motions(const runtime::Round& round) const;
  bool choose_ghosts();
  bool choose_hosted(OwnerLink& link);
  void find_touching(OwnerLink& link, std::vector<std::uint32_t>& out);
  void update_shared();
  void locate_hosted();
  ElementState start_of(const SharedElement& shared, SubModelId world) const;
  void start_all_shared();
  void start_shared(SharedElement& shared);
  void unshare(const SharedElement& shared);
  void send_ghosts(const OwnerLink& link, runtime::Port& port);

  static std::array<double, 3> point(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
  double list_points(std::span<const BorderElement> bodies);
  bool about_to_meet(const BodyMotion& own, double radius, const BorderElement& other) const;
  void note_meetings();
  void note_meetings_at(const OwnerLink& link);
  void note_meetings_here();
  bool meets_here(std::uint32_t member) const;
  void list_bodies_here();

  bool driven(const runtime::Round& round) const;
  bool still(const runtime::Round& round) const;
  void watch_rest(const runtime::Round& round);
  void wake();
  void rest_account();
  void mirror_at_rest(const runtime::Round& round, const runtime::Port& port);
  bool receive_at_rest(OwnerLink& link, std::span<const std::byte> bytes, bool opening);
  bool disturbed(const runtime::Round& round, const runtime::Port& port);
  bool disturbs(const HostLink& link, const BoundMessage& message) const;
  bool pushes(const OwnerLink& link, const StepMessage& message) const;

  void list_partners();
  template <class Io, class Self>
  static void fields(Io& s, Self& self);

  std::size_t member_index(std::uint32_t element) const;

  const ModelContext& context_;
  SubModelId id_;
  Vec3 origin_;  ///< of the world's own numbers
  std::vector<std::uint32_t> members_;
  std::vector<Slot> slots_;
  // By member, beside the scene's elements, which lie far apart
  std::vector<double> radius_, mass_;       ///< bounding radius [m], full mass [kg]
  std::vector<std::uint32_t> shape_;        ///< index into Scene::shapes
  std::vector<std::int32_t> shared_index_;  ///< by member; -1: not shared
  std::unique_ptr<World> world_;

  std::vector<HostLink> host_links_;    ///< ascending owner
  std::vector<OwnerLink> owner_links_;  ///< ascending host
  std::vector<runtime::SubModelId> owners_, hosts_;
  std::vector<SharedElement> shared_;       ///< ascending element
  std::vector<std::uint32_t> inner_bonds_;  ///< among members at the start, ascending
  std::vector<std::uint32_t> broken_;       ///< bonds known broken, ascending
  std::vector<std::uint32_t> newly_broken_;

  std::vector<BodyMotion> motions_;  ///< of members, canonical after the force mirror
  Bounds bounds_;
  double max_speed_ = 0;
  bool finite_ = true;         ///< all numbers of motions_
  double largest_radius_ = 0;  ///< of the members [m]
  double approached_ = 0;      ///< how far a member and a neighbour's may have come closer since ghosts were chosen [m]
  Ledger ledger_;              ///< what was given; what members have is summed when asked for
  double total_mass_ = 0;      ///< of the members
  Vec3 mass_moment_ = Vec3::Zero();  ///< when forces act in the next substep: sum of m x
  double disagreement_ = 0;
  std::uint64_t disagreements_ = 0;
  std::uint64_t ghost_rounds_ = 0, rounds_ = 0;
  bool interrupted_ = false;
  bool resting_ = false;           ///< does not advance
  std::int64_t still_rounds_ = 0;  ///< in a row, until now
  Ledger still_since_;             ///< at the first of them
  Ledger at_rest_;                 ///< what every round at rest adds to the accounts
  std::uint64_t rested_ = 0;       ///< sum over rounds of the elements that did not advance

  // Buffers, reused
  std::vector<std::byte> bytes_;
  StepMessage step_message_;
  BoundMessage bound_message_;
  CellGrid<double> grid_;
  std::vector<std::array<double, 3>> points_;
  std::vector<BorderElement> here_;
  std::vector<std::uint32_t> found_;
  std::vector<CopyMotion> copy_motions_;
  std::vector<std::pair<std::uint32_t, SubModelId>> wanted_;  ///< element, host
  std::vector<SharedElement> shared_before_;
  std::vector<Ghost> ghosts_before_;
};

}  // namespace moraine
