// SPDX-License-Identifier: Apache-2.0
// An impulse world to bytes and back. Lists are not saved: they never influence what is computed.
#include "physics/bytes.hpp"
#include "physics/impulse/world.hpp"

namespace moraine::impulse {
namespace {

constexpr std::uint32_t magic = 0x5049424dU;  // "MBIP"
constexpr std::uint32_t version = 3;

/// Records of numbers without gaps between them, which Eigen does not let the compiler call trivial.
template <class T>
void put_all(ByteWriter& w, std::span<const T> records) {
  w.put_all(std::as_bytes(records));
}
template <class T>
void put_all(ByteWriter& w, const std::vector<T>& records) {
  put_all(w, std::span<const T>(records));
}
template <class T>
void get_all(ByteReader& r, std::vector<T>& records) {
  std::vector<std::byte> bytes;
  r.get_all(bytes);
  if (bytes.size() % sizeof(T) != 0) throw IoError("saved state is damaged");
  records.resize(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(static_cast<void*>(records.data()), bytes.data(), bytes.size());
}
template <class T>
std::vector<T> get_all(ByteReader& r) {
  std::vector<T> records;
  get_all(r, records);
  return records;
}

}  // namespace

void ImpulseWorld::save(std::vector<std::byte>& out) const {
  ByteWriter w(out);
  w.put(magic);
  w.put(version);
  put_all(w, bodies_.roster.members());
  w.put(static_cast<std::uint64_t>(bodies_.roster.slots()));
  put_all(w, bodies_.roster.free_slots());
  put_all(w, bodies_.position);
  put_all(w, bodies_.moving);
  put_all(w, bodies_.material);
  put_all(w, bodies_.attitude);
  put_all(w, bodies_.ghost);
  put_all(w, bodies_.carries);
  put_all(w, pairs_.rows());
  put_all(w, walls_.rows());
  put_all(w, bonds_.entries());
}

void ImpulseWorld::load(std::span<const std::byte> in) {
  ByteReader r(in);
  if (r.get<std::uint32_t>() != magic || r.get<std::uint32_t>() != version)
    throw IoError("not a saved impulse world of this version");
  auto members = get_all<native::Roster::Member>(r);
  const auto slots = r.get<std::uint64_t>();
  bodies_.roster.restore(std::move(members), slots, get_all<Slot>(r));
  get_all(r, bodies_.position);
  get_all(r, bodies_.moving);
  get_all(r, bodies_.material);
  get_all(r, bodies_.attitude);
  get_all(r, bodies_.ghost);
  get_all(r, bodies_.carries);
  pairs_.restore(bodies_, get_all<PairRow>(r));
  walls_.restore(get_all<WallRow>(r));
  bonds_.clear();
  for (const Bonds::Entry& e : get_all<Bonds::Entry>(r)) bonds_.add(e);
  for (const Moving& m : bodies_.moving) turns_ |= !three(m.turning).isZero(0);
  listed_ = false;
}

}  // namespace moraine::impulse
