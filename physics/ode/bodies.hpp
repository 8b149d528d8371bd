// SPDX-License-Identifier: Apache-2.0
// The bodies of a world: what they are between steps, and ODE's bodies that
// stand in for them during one.
#pragma once

#include <array>
#include <vector>

#include "physics/native/roster.hpp"
#include "physics/native/sized_grid.hpp"
#include "physics/ode/geometry.hpp"
#include "physics/ode/units.hpp"

namespace moraine::ode {

using native::nowhere;
using native::Place;

/// All that a world knows of a body between steps, in scaled units; plain
/// numbers, so that it can be saved as it is.
struct Record {
  std::array<double, 3> position{}, velocity{}, spin{};
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< w, x, y, z
  double mass = 0;
  std::uint32_t shape = 0, material = 0;
  std::uint32_t ghost = 0, unused = 0;
};

class Bodies {
 public:
  Bodies(dWorldID world, const Scene& scene, const Units& units) : world_(world), scene_(scene), units_(units) {}
  Bodies(const Bodies&) = delete;
  Bodies& operator=(const Bodies&) = delete;
  ~Bodies();

  std::size_t size() const { return roster.size(); }
  Place place(Slot slot) const { return roster.place(slot); }
  const Shape& shape(Place p) const { return scene_.shapes[records[p].shape]; }

  Slot add(const Body& body);
  void set_state(Place p, const ElementState& state);
  ElementState state(Place p) const { return {{position(p), orientation(p)}, twist(p)}; }
  Vec3 position(Place p) const { return units_.world(vec(records[p].position.data())); }
  Twist twist(Place p) const;
  void push(Place p, const Impulse& impulse);
  native::Ball ball(Place p) const { return {position(p), shape(p).bounding_radius}; }

  /// Puts all in id order, with an ODE body for each; see roster.moved().
  void settle();
  /// Tells ODE's bodies what is in the records. After that ODE has nothing from
  /// steps before. Those that are not sound sit the step out.
  void upload();
  void download();
  /// All its numbers are finite; ODE gives up on a world with others.
  bool sound(Place p) const { return sound_[p] != 0; }

  dBodyID body(Place p) const { return handles_[p].body; }
  const std::vector<Geom>& parts(Place p) const { return handles_[p].parts; }

  native::Roster roster;
  std::vector<Record> records;
  std::vector<std::uint8_t> ghost;  ///< as the records say, for the search of pairs

 private:
  struct Handle {
    dBodyID body = nullptr;
    std::uint32_t shape = ~0U;  ///< that its parts have
    double mass = 0;            ///< that ODE has been told for this shape
    std::vector<Geom> parts;
  };
  Quat orientation(Place p) const;
  Vec3 inertia(Place p) const { return records[p].mass * shape(p).inertia_per_mass / (units_.length * units_.length); }
  void fit(Place p);

  dWorldID world_;
  const Scene& scene_;
  const Units& units_;
  std::vector<Handle> handles_;      ///< by place; ODE goes through bodies in the
                                     ///< order they were made
  std::vector<std::uint8_t> sound_;  ///< by place, since upload()
};

}  // namespace moraine::ode
