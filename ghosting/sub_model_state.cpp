// SPDX-License-Identifier: Apache-2.0
// A sub-model to bytes and back: its world, and all that it knows of its neighbours and of what copies carry.
#include <Eigen/Core>

#include "ghosting/sub_model.hpp"
#include "physics/bytes.hpp"

namespace moraine {
namespace {

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
    all(s, x.world, x.offset, x.lasting);
  } else if constexpr (std::is_same_v<U, SharedElement>) {
    all(s, x.element, x.member, x.state, x.copies, x.start);
  } else if constexpr (std::is_same_v<U, CrossBond>) {
    all(s, x.bond, x.own, x.other);
  } else if constexpr (std::is_same_v<U, Ghost>) {
    all(s, x.element, x.slot, x.start);
  } else if constexpr (std::is_same_v<U, HostLink>) {
    all(s, x.owner, x.bounds, x.max_speed, x.ghosts, x.bonds, x.held);
  } else if constexpr (std::is_same_v<U, OwnerLink>) {
    all(s, x.host, x.hosted, x.bonds);
  } else {
    static_assert(std::is_same_v<U, Ledger>);
    all(s, x.momentum, x.given, x.exchanged, x.exchanged_angular, x.kinetic_energy, x.speed_sum, x.spin_scale,
        x.mass_moment, x.mass);
  }
}

template <class Io, class... Fields>
void all(Io& s, Fields&... fields) {
  (io(s, fields), ...);
}

}  // namespace

/// Border elements and results are of one round only and are exchanged anew in the opening round of an epoch.
template <class Io, class Self>
void SubModel::fields(Io& s, Self& self) {
  all(s, self.members_, self.slots_, self.shared_index_, self.host_links_, self.owner_links_, self.shared_,
      self.broken_, self.bounds_, self.max_speed_, self.largest_radius_, self.approached_, self.ledger_,
      self.disagreement_, self.disagreements_, self.ghost_rounds_, self.rounds_, self.radius_, self.mass_);
}

void SubModel::save(std::vector<std::byte>& out) const {
  std::vector<std::byte> world;
  world_->save(world);
  ByteWriter w(out);
  w.put_all(std::span<const std::byte>(world));
  fields(w, *this);
}

void SubModel::load(std::span<const std::byte> in) {
  ByteReader r(in);
  std::vector<std::byte> world;
  r.get_all(world);
  world_->load(world);
  fields(r, *this);
  list_partners();
  locate_hosted();
  read_motions();
  for (const SharedElement& s : shared_) motions_[s.member] = {s.state.pose.position, s.state.twist};
}

}  // namespace moraine
