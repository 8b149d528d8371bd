// SPDX-License-Identifier: Apache-2.0
// How the copies of one element stay one element: the contract of a coupling and the table of them.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "physics/types.hpp"
#include "physics/world.hpp"

namespace moraine {

/// One copy of a shared element: the real one in its owner's world or a ghost in a host's world.
struct Copy {
  static constexpr std::int32_t never = 1000;

  SubModelId world = 0;
  Twist offset;          ///< of the copy's velocity from the element's at the start of a substep: what it carries
  Twist lasting;         ///< slow mean of the offset: the load it has carried for long
  double share = 0;      ///< of the element's mass and inertia
  bool carries = false;  ///< as the engine is told, see Body
  bool meets = false;    ///< of a ghost: it touches something in its world, or is about to
  std::int32_t unpushed = never;  ///< substeps since anything but gravity acted on it, or was about to; at most that

  /// A copy that carries nothing yet.
  static Copy in(SubModelId world) {
    Copy copy;
    copy.world = world;
    return copy;
  }
};

/// What a copy did in one substep.
struct CopyMotion {
  Vec3 displacement = Vec3::Zero();  ///< [m]
  Vec3 rotation = Vec3::Zero();      ///< rotation vector, world frame [rad]
  Twist twist;                       ///< at the end
};

/// An element with ghosts, as its owner knows it.
struct SharedElement {
  std::uint32_t element = 0;  ///< index into Scene::elements
  std::uint32_t member = 0;   ///< place among its owner's elements
  ElementState state;         ///< the one canonical state
  std::vector<Copy> copies;   ///< ascending world; includes the real one
  ElementState start;         ///< of the real copy, as its world holds it in this substep
  ElementState end;           ///< of the real copy after the substep

  Copy& copy_in(SubModelId world) {
    return *std::find_if(copies.begin(), copies.end(), [&](const Copy& c) { return c.world == world; });
  }
  const Copy& copy_in(SubModelId world) const { return const_cast<SharedElement*>(this)->copy_in(world); }
};

/// What a coupling may use besides the element itself.
struct CouplingContext {
  SubModelId owner = 0;
  Vec3 gravity_step = Vec3::Zero();  ///< velocity that gravity adds in a substep [m/s]
  double leak = 0;                   ///< RunSettings::coupling_leak
};

/// Contract. Pure functions of their arguments; sums run over the copies in the order given (ascending world).
class Coupling {
 public:
  virtual ~Coupling() = default;
  /// Whether `host` makes ghosts of elements of its neighbour `owner`.
  virtual bool hosts(SubModelId host, SubModelId owner) const = 0;
  /// Before a substep: gives every copy its share of the element's mass and inertia. Twice is as once.
  virtual void share_out(SharedElement& shared, SubModelId owner) const = 0;
  /// Turns what the copies did (one motion per copy; none if ghosts are followers) into the element's new state and the
  /// copies' new offsets. Returns the squared speed by which the copies disagreed, summed over copies [m^2/s^2].
  virtual double combine(SharedElement& shared, std::span<const CopyMotion> motions,
                         const CouplingContext& context) const = 0;
  /// The set of worlds changes (both lists ascending): adjusts the copies, keeping the sum of what they carry.
  virtual void change_copies(SharedElement& shared, std::span<const SubModelId> worlds, SubModelId owner) const = 0;
};

struct CouplingRow {
  std::string_view name;
  std::string_view help;
  std::unique_ptr<Coupling> (*make)();
  GhostKind ghosts = GhostKind::partner;  ///< engines of this kind only
  double skin = 0.05;                     ///< unless the scene states one [element diameters]
};

std::span<const CouplingRow> couplings();
/// The row of this name; of "auto", the first that fits the engine.
/// Errors: InputError that prints the table; one that names what fits if the named one does not.
const CouplingRow& find_coupling(std::string_view name, const Engine& engine);

std::unique_ptr<Coupling> make_consensus();
std::unique_ptr<Coupling> make_exact();
std::unique_ptr<Coupling> make_mirror();

/// Rotates an orientation by a rotation vector given in the world frame.
Quat rotated(const Quat& q, const Vec3& rotation);
/// The rotation vector, world frame, that takes `from` to `to` by the shorter way.
Vec3 rotation_between(const Quat& from, const Quat& to);

}  // namespace moraine
