// SPDX-License-Identifier: Apache-2.0
// The engine contract: a world is one black-box rigid-body engine holding one sub-model.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/types.hpp"

namespace moraine {

/// real: owned here. ghost: a copy of an element owned elsewhere; it meets real elements only.
enum class Role : std::uint8_t { real, ghost };

/// What a scene uses; an engine leaves the rest out.
struct Features {
  bool friction = true;
  bool rotation = true;  ///< something turns or may begin to
  bool restitution = true;
  bool bonds = true;
  bool spheres_only = false;
};

/// What one world of an engine may hold. A scene that needs more is refused, or cut finer.
struct Limits {
  std::size_t elements = SIZE_MAX;  ///< shapes, ghosts and boundaries included
  std::size_t contact_pairs = SIZE_MAX;
  std::size_t worlds = SIZE_MAX;  ///< per process
  double ghost_reserve = 0;       ///< share of the limit kept free for ghosts
  /// Touching equal spheres (6 pairs each in a packed block) that fit, reserve not yet taken off.
  std::size_t packed_spheres() const { return std::min(elements, contact_pairs / 12); }
};

/// Units and settings common to all worlds of a run. Lengths, times and masses inside an engine are divided by the
/// units, so the same scene at another scale gives the same numbers.
struct WorldSettings {
  double length_unit = 1;  ///< typical element diameter [m]
  double time_unit = 1;    ///< sqrt(length_unit / g), or of the order of 100 substeps without gravity [s]
  double mass_unit = 1;    ///< typical element mass [kg]
  Vec3 gravity = Vec3::Zero();
  double substep = 0;  ///< [s]
  int iterations = 10;
  double overlap_recovery = 0.1;  ///< share of an overlap removed per substep
  Features features;
  Limits limits;
  const Scene* scene = nullptr;  ///< shapes, materials and boundaries are read from here; outlives the world
};

/// A body as the world is asked to add it. Mass is the copy's share of the element's mass. A copy that carries starts
/// substeps with a load that it bears for the element's other copies, in the form of a velocity, which is no approach.
struct Body {
  ElementId id = 0;
  std::uint32_t shape = 0;
  std::uint32_t material = 0;
  double mass = 0;
  Role role = Role::real;
  ElementState state;
  bool carries = false;
};

/// The part of a body's state that every step looks at.
struct BodyMotion {
  Vec3 position = Vec3::Zero();
  Twist twist;
};

/// A body's place in a world: dense, reused after removal, meaningless outside this world.
using Slot = std::uint32_t;

struct Contact {
  ElementId a = 0;
  ElementId b = 0;  ///< the other element, or the boundary's index if with_boundary
  bool with_boundary = false;
  Vec3 point = Vec3::Zero();    ///< world frame [m]
  Vec3 normal = Vec3::Zero();   ///< unit, towards a
  double overlap = 0;           ///< [m], negative: gap
  Vec3 impulse = Vec3::Zero();  ///< on a, over the last step [N s]
};
/// The order in which worlds list them.
inline bool earlier(const Contact& p, const Contact& q) {
  return std::tuple(p.a, p.with_boundary, p.b) < std::tuple(q.a, q.with_boundary, q.b);
}

/// What a contact remembers beyond the states of its bodies. It goes along when elements change worlds.
struct ContactMemory {
  ElementId a = 0;
  std::uint32_t b = 0;  ///< the other element, or the boundary's index if with_boundary
  bool with_boundary = false;
  Vec3 normal = Vec3::Zero();   ///< with a boundary: unit, towards a; tells several contacts with one boundary apart
  Vec3 sliding = Vec3::Zero();  ///< stretch of the tangential spring [m]
  Vec3 rolling = Vec3::Zero();  ///< stretch of the rolling spring [m]
};

/// Deterministic counters of the work of the last step; never a clock.
struct StepWork {
  std::uint64_t bodies = 0;
  std::uint64_t contacts = 0;
  std::uint64_t bonds = 0;
};

/// Contract. All quantities SI and world frame at this surface. Same calls in the same order give the same bits; no
/// call depends on another world. Not thread-safe: one caller at a time per world; different worlds run concurrently.
class World {
 public:
  virtual ~World() = default;

  /// Errors: InputError if a limit is exceeded (names the limit and the count).
  virtual Slot add(const Body& body) = 0;
  virtual void remove(Slot slot) = 0;
  virtual void set_state(Slot slot, const ElementState& state) = 0;
  virtual ElementState state(Slot slot) const = 0;
  // Parts of it, asked for in every step: worth an answer that is quicker than the whole state.
  virtual Vec3 position(Slot slot) const { return state(slot).pose.position; }
  /// Motions of many bodies at once, in the order asked for.
  virtual void motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const;
  /// Changes the copy's share of the element's mass, in proportion to which inertia follows, and whether it carries.
  virtual void set_mass(Slot slot, double mass, bool carries) = 0;
  virtual void apply_impulse(Slot slot, const Impulse& impulse) = 0;

  /// Adds scene bond `bond` between two bodies of this world; dropped again with remove_bond or when it breaks.
  /// Not called if the engine's row says that it has none.
  virtual void add_bond(std::uint32_t bond, Slot a, Slot b);
  virtual void remove_bond(std::uint32_t) {}
  /// Scene bonds that broke during the last step, ascending.
  virtual std::span<const std::uint32_t> broken_bonds() const { return {}; }

  /// Advances by one substep from time t [s]: boundaries move as prescribed, forces act, bodies move.
  virtual void step(double t) = 0;

  /// Total impulse that boundaries gave to real bodies in the last step; angular part about the world origin.
  virtual Impulse boundary_impulse() const = 0;
  /// Work that driven boundaries did on real bodies in the last step [J]: impulse times velocity of the surface.
  virtual double boundary_work() const = 0;
  /// Elastic energy in the contacts of real bodies now [J]; a contact with a ghost counts half. 0 if contacts are
  /// rigid. Cost: linear in contacts; not for every step.
  virtual double contact_energy() const { return 0; }
  /// Contacts of the last step, ascending (a, b). Cost: linear in contacts; not for every step.
  virtual std::vector<Contact> contacts() const = 0;
  /// Calls visit for each of them, in an order that does not depend on anything unsaved.
  virtual void each_contact(const std::function<void(const Contact&)>& visit) const;
  virtual StepWork work() const = 0;

  /// What the contacts of this world's bodies remember, ghosts' included; nothing if the engine's contacts remember
  /// nothing that matters elsewhere.
  virtual std::vector<ContactMemory> contact_memory() const { return {}; }
  /// Before the next step: contacts that began in other worlds go on here, if both bodies will be here by then.
  virtual void remember(std::span<const ContactMemory>) {}

  /// Forgets whatever a saved world cannot carry. Called in every world at the same step, whether it is saved, moved or
  /// stays, so that all three continue alike.
  virtual void canonicalise() = 0;
  /// Bit-exact image of the world right after canonicalise(); load() into a world made with the same settings continues
  /// as this one would.
  virtual void save(std::vector<std::byte>& out) const = 0;
  virtual void load(std::span<const std::byte> in) = 0;
};

/// What copies of an element in other worlds are to an engine.
enum class GhostKind : std::uint8_t {
  partner,  ///< part of the element: what happens to it is joined with what happens to the real one
  follower  ///< shows the owner's state; every world works out the same forces from the same states
};

/// The largest substep that an engine takes for a scene.
struct StepLimit {
  double substep = std::numeric_limits<double>::infinity();  ///< [s]
  std::string reason;                                        ///< what sets it; empty: there is no limit
};

/// A row of the engine table.
struct Engine {
  std::string_view name;
  std::string_view help;
  std::string_view precision;  ///< "float32" or "float64"
  bool (*supports)(const Geometry&);
  /// Seconds per element-step of one world of n bodies, relative: what `auto` splitting weighs.
  double (*relative_cost)(double bodies);
  std::unique_ptr<World> (*make)(const WorldSettings&, const Vec3& origin);
  GhostKind ghosts = GhostKind::partner;
  /// Part of what copies carry that survives a substep, unless a scene states it: as much as stays at rest.
  double coupling_leak = 0.85;
  bool bonds = true;  ///< it can do them; scenes with bonds are refused otherwise
  /// When in a substep forces act, 0 .. 1: 0 at its start (semi-implicit Euler), 0.5 in the middle (Verlet).
  double force_time = 0;
  /// What else it cannot run. Errors: InputError naming the limit and the value.
  void (*check)(const Scene&) = [](const Scene&) {};
  StepLimit (*step_limit)(const Scene&) = [](const Scene&) { return StepLimit{}; };
  /// Up to which it is at its best; beyond, it is stable but wrong.
  StepLimit (*advised_step)(const Scene&) = [](const Scene&) { return StepLimit{}; };
};

std::span<const Engine> engines();
/// Errors: InputError that prints the table.
const Engine& find_engine(std::string_view name);
/// The same for a scene; `auto` is impulse for scenes of spheres, which it is made for, and bullet otherwise.
const Engine& find_engine(std::string_view name, const Scene& scene);

}  // namespace moraine
