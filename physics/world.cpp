// SPDX-License-Identifier: Apache-2.0
// What engines need not write themselves.
#include "physics/world.hpp"

#include "physics/errors.hpp"

namespace moraine {

void World::motions(std::span<const Slot> slots, std::vector<BodyMotion>& out) const {
  out.clear();
  for (const Slot slot : slots) {
    const ElementState s = state(slot);
    out.push_back({s.pose.position, s.twist});
  }
}

void World::each_contact(const std::function<void(const Contact&)>& visit) const {
  for (const Contact& c : contacts()) visit(c);
}

void World::add_bond(std::uint32_t, Slot, Slot) { throw InputError("this engine has no bonds"); }

}  // namespace moraine
