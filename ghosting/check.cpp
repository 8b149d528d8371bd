// SPDX-License-Identifier: Apache-2.0
#include "ghosting/check.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "ghosting/model.hpp"

namespace moraine {
namespace {

[[noreturn]] void broken(std::string text) { throw std::logic_error("broken invariant: " + std::move(text)); }

void verify_owned_once(const CoupledModel& model) {
  std::vector<int> owners(model.scene().elements.size(), 0);
  for (std::size_t p = 0; p < model.size(); ++p) {
    if (!model.holds(p)) continue;
    for (const std::uint32_t e : model.part(p).members()) {
      if (model.owners()[e] != p) broken(fmt::format("element {} is not where the split put it", e));
      ++owners[e];
    }
  }
  for (std::size_t e = 0; e < owners.size(); ++e)
    if (owners[e] != (model.holds(model.owners()[e]) ? 1 : 0))
      broken(fmt::format("element {} is owned {} times", e, owners[e]));
}

/// The host has the ghosts the owner ordered a substep ago; the owner's list may have changed since.
void verify_ghosts(const CoupledModel& model, const SubModel& host) {
  for (const HostLink& link : host.host_links())
    for (const Ghost& g : link.ghosts)
      if (model.owners()[g.element] != link.owner)
        broken(fmt::format("ghost {} in sub-model {} is not of sub-model {}", g.element, host.id(), link.owner));
}

void verify_shared(const SubModel& part, bool offsets_sum_to_zero) {
  for (const SharedElement& s : part.shared()) {
    Vec3 sum = Vec3::Zero();
    double scale = 0;
    bool own = false;
    for (const Copy& c : s.copies) {
      sum += c.share * c.offset.linear;
      scale += c.share * c.offset.linear.norm() + s.state.twist.linear.norm();
      own = own || c.world == part.id();
    }
    if (!own) broken(fmt::format("shared element {} has no copy at its owner", s.element));
    if (offsets_sum_to_zero && sum.norm() > 1e-9 * scale + 1e-12)
      broken(fmt::format("what the copies of element {} carry does not sum to nothing", s.element));
  }
}

}  // namespace

void verify_invariants(const CoupledModel& model) {
  verify_owned_once(model);
  for (std::size_t p = 0; p < model.size(); ++p) {
    if (!model.holds(p)) continue;
    verify_ghosts(model, model.part(p));
    verify_shared(model.part(p), model.coupling().name == "consensus");
  }
}

}  // namespace moraine
