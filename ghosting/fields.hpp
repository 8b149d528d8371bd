// SPDX-License-Identifier: Apache-2.0
// What the parts of a sub-model's state consist of, for writing them to bytes and reading them back.
#pragma once

#include <Eigen/Core>
#include <type_traits>
#include <vector>

#include "ghosting/accounts.hpp"
#include "ghosting/guards.hpp"
#include "ghosting/report.hpp"
#include "ghosting/sub_model.hpp"
#include "physics/bytes.hpp"

namespace moraine::fields {

// Writing and reading share one list of fields per type, so that none can be written and not read back.

void value(ByteWriter& w, const auto& x) { w.put(x); }
template <class T>
void value(ByteReader& r, T& x) {
  x = r.get<T>();
}

template <class T>
void resize(ByteWriter& w, const std::vector<T>& x) {
  w.put(static_cast<std::uint64_t>(x.size()));
}
template <class T>
void resize(ByteReader& r, std::vector<T>& x) {
  x.resize(r.get<std::uint64_t>());
}

template <class T>
constexpr bool is_vector = false;
template <class T>
constexpr bool is_vector<std::vector<T>> = true;

template <class Io, class... Fields>
void all(Io& s, Fields&... fields);

template <class Io, class T>
void io(Io& s, T& x) {
  using U = std::remove_const_t<T>;
  if constexpr (std::is_arithmetic_v<U>) {
    value(s, x);
  } else if constexpr (is_vector<U>) {
    resize(s, x);
    for (auto& item : x) io(s, item);
  } else if constexpr (std::is_same_v<U, Vec3>) {
    all(s, x.x(), x.y(), x.z());
  } else if constexpr (std::is_same_v<U, Quat>) {
    all(s, x.coeffs()[0], x.coeffs()[1], x.coeffs()[2], x.coeffs()[3]);
  } else if constexpr (std::is_same_v<U, Twist> || std::is_same_v<U, Impulse>) {
    all(s, x.linear, x.angular);
  } else if constexpr (std::is_same_v<U, ElementState>) {
    all(s, x.pose.position, x.pose.orientation, x.twist);
  } else if constexpr (std::is_same_v<U, Bounds>) {
    all(s, x.min, x.max);
  } else if constexpr (std::is_same_v<U, Copy>) {
    all(s, x.world, x.offset, x.lasting, x.share, x.carries, x.meets, x.unpushed);
  } else if constexpr (std::is_same_v<U, SharedElement>) {
    all(s, x.element, x.member, x.state, x.copies, x.start);
  } else if constexpr (std::is_same_v<U, CrossBond>) {
    all(s, x.bond, x.own, x.other);
  } else if constexpr (std::is_same_v<U, Ghost>) {
    all(s, x.element, x.slot, x.start);
  } else if constexpr (std::is_same_v<U, GhostResult>) {
    all(s, x.element, x.motion.displacement, x.motion.rotation, x.motion.twist);
  } else if constexpr (std::is_same_v<U, HostLink>) {
    all(s, x.owner, x.bounds, x.max_speed, x.owner_rests, x.ghosts, x.bonds, x.held);
  } else if constexpr (std::is_same_v<U, OwnerLink>) {
    all(s, x.host, x.hosted, x.bonds, x.meeting, x.results);
  } else if constexpr (std::is_same_v<U, ContactMemory>) {
    all(s, x.a, x.b, x.with_boundary, x.normal, x.sliding, x.rolling);
  } else if constexpr (std::is_same_v<U, Accounts>) {
    all(s, x.opening, x.closed, x.recuts, x.disagreement, x.disagreements, x.ghost_rounds, x.rounds, x.rested,
        x.broken_bonds, x.ghosts_max, x.speed_sum_max, x.spin_scale_max, x.kinetic_max, x.bond_max, x.least_energy,
        x.gained, x.marked_round, x.marked_impulse);
  } else if constexpr (std::is_same_v<U, Worst>) {
    all(s, x.value, x.element);
  } else if constexpr (std::is_same_v<U, Extremes>) {
    all(s, x.speed, x.stride, x.beyond, x.below);
  } else if constexpr (std::is_same_v<U, GuardLog::Entry>) {
    all(s, x.count, x.first, x.first_step, x.worst, x.worst_step);
  } else if constexpr (std::is_same_v<U, GuardLog>) {
    all(s, x.entries, x.looks, x.disagreement, x.disagreements);
  } else if constexpr (std::is_same_v<U, Report>) {
    all(s, x.bounds, x.max_speed, x.extremes, x.ledger, x.disagreement, x.disagreements, x.ghosts, x.ghost_rounds,
        x.rounds, x.rested, x.broken_bonds);
  } else {
    static_assert(std::is_same_v<U, Ledger>);
    all(s, x.momentum, x.given, x.exchanged, x.exchanged_angular, x.from_boundaries, x.work, x.kinetic_energy,
        x.potential_energy, x.bond_energy, x.contact_energy, x.speed_sum, x.spin_scale, x.mass_moment, x.mass);
  }
}

template <class Io, class... Fields>
void all(Io& s, Fields&... fields) {
  (io(s, fields), ...);
}

}  // namespace moraine::fields
