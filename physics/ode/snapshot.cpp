// SPDX-License-Identifier: Apache-2.0
// An ODE world to bytes and back.
#include "physics/bytes.hpp"
#include "physics/ode/world.hpp"

namespace moraine::ode {
namespace {

constexpr std::uint32_t magic = 0x444f424dU;  // "MBOD"
constexpr std::uint32_t version = 1;

}  // namespace

void OdeWorld::save(std::vector<std::byte>& out) const {
  ByteWriter w(out);
  w.put(magic);
  w.put(version);
  bodies_.roster.save(w);
  w.put_all(std::span<const Record>(bodies_.records));
  w.put_all(std::span<const Bonds::Entry>(bonds_.entries()));
}

void OdeWorld::load(std::span<const std::byte> in) {
  ByteReader r(in);
  if (r.get<std::uint32_t>() != magic || r.get<std::uint32_t>() != version)
    throw IoError("not a saved ode world of this version");
  bodies_.roster.load(r);
  r.get_all(bodies_.records);
  bodies_.ghost.clear();
  for (const Record& record : bodies_.records) bodies_.ghost.push_back(record.ghost != 0);
  bodies_.settle();
  std::vector<Bonds::Entry> bonds;
  r.get_all(bonds);
  bonds_.clear();
  for (const Bonds::Entry& e : bonds) bonds_.add(e);
  touches_.clear();
  feedback_.clear();
  stale_ = true;
}

}  // namespace moraine::ode
