// SPDX-License-Identifier: Apache-2.0
#include "ghosting/mass_split.hpp"

#include <algorithm>

namespace moraine {
namespace {

constexpr double idle_share = 0.001;
/// Substeps for which a copy that was pushed keeps its part: contacts that tremble must not send the mass to and fro.
constexpr std::int32_t remembered = 2;
/// Pushes below are rounding [shares of what gravity adds, and of the speed].
constexpr double push_of_gravity = 1e-3, push_of_speed = 1e-5;

void set_share(Copy& c, double share) {
  const double rescale = c.share / share;
  c.offset = rescale * c.offset;
  c.lasting = rescale * c.lasting;
  c.share = share;
}

/// Takes from a copy what it carries, per mass of the element.
void take(Copy& from, Twist& offset, Twist& lasting) {
  offset += from.share * from.offset;
  lasting += from.share * from.lasting;
  from.offset = from.lasting = {};
}

}  // namespace

bool busy(const Copy& c) { return c.meets || c.unpushed <= remembered; }

void split_mass(std::vector<Copy>& copies, SubModelId owner) {
  const auto any = static_cast<std::size_t>(std::count_if(copies.begin(), copies.end(), busy));
  const auto has_mass = [&](const Copy& c) { return any > 0 ? busy(c) : c.world == owner; };
  const auto heirs = static_cast<double>(std::max<std::size_t>(any, 1));
  const double share = (1 - idle_share * (static_cast<double>(copies.size()) - heirs)) / heirs;
  Twist offset, lasting;
  for (Copy& c : copies) {
    set_share(c, has_mass(c) ? share : idle_share);
    c.carries = any > 1 && busy(c);
    if (!c.carries) take(c, offset, lasting);
  }
  if (any < 2) return;
  for (Copy& c : copies) {
    if (!c.carries) continue;
    c.offset += 1 / (heirs * share) * offset;
    c.lasting += 1 / (heirs * share) * lasting;
  }
}

void note_push(Copy& copy, double push, double speed, double gravity_step) {
  const bool pushed = push > push_of_gravity * gravity_step + push_of_speed * speed;
  copy.unpushed = pushed ? 0 : std::min(copy.unpushed + 1, Copy::never);
}

}  // namespace moraine
