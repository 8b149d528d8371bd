// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/bonds.hpp"

#include <algorithm>
#include <cmath>

namespace moraine::impulse {
namespace {

constexpr float explicit_limit = 0.5F;  ///< h sqrt(k/m*) up to which bonds are integrated without numerical damping

}  // namespace

void Bonds::add(const Entry& entry) {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), entry.bond,
                                   [](const Entry& e, std::uint32_t wanted) { return e.bond < wanted; });
  entries_.insert(at, entry);
}

void Bonds::remove(std::uint32_t bond) {
  std::erase_if(entries_, [&](const Entry& e) { return e.bond == bond; });
}

Vec Bonds::between(const Entry& e, const Bodies& bodies) const {
  return three(bodies.position[bodies.place(e.a)] - bodies.position[bodies.place(e.b)]);
}

void Bonds::break_long(const Bodies& bodies) {
  broken_.clear();
  for (const Entry& e : entries_) {
    const auto limit = static_cast<float>(scene_->bonds[e.bond].break_length / units_.length);
    if (!(between(e, bodies).squaredNorm() <= limit * limit)) broken_.push_back(e.bond);
  }
  if (broken_.empty()) return;
  std::erase_if(entries_, [&](const Entry& e) { return std::binary_search(broken_.begin(), broken_.end(), e.bond); });
}

void Bonds::gather(const Bodies& bodies, float h) {
  rows_.clear();
  for (const Entry& e : entries_) rows_.push_back(row(e, bodies, h));
}

/// Impulse over a step: h (k (length + h v - rest) + c v) with the speed v at its end if the spring is stiff for the
/// step (implicit Euler), else h (k (length - rest) + c v) (symplectic Euler with implicit damping).
Bonds::Row Bonds::row(const Entry& e, const Bodies& bodies, float h) const {
  const Bond& bond = scene_->bonds[e.bond];
  const auto stiffness = static_cast<float>(bond.stiffness / units_.stiffness());
  const auto damping = static_cast<float>(bond.damping / (units_.stiffness() * units_.time));
  const Vec line = between(e, bodies);
  const float length = line.norm(), rest = static_cast<float>(bond.rest_length / units_.length);
  Row r;
  r.a = bodies.place(e.a);
  r.b = bodies.place(e.b);
  r.axis = length > 0 ? Vec(line / length) : Vec(Vec::UnitZ());
  r.inverse_mass_a = bodies.moving[r.a].inverse_mass();
  r.inverse_mass_b = bodies.moving[r.b].inverse_mass();
  const bool stiff = h * std::sqrt(stiffness * (r.inverse_mass_a + r.inverse_mass_b)) > explicit_limit;
  r.pull = h * stiffness * (length - rest);
  r.drag = h * ((stiff ? h * stiffness : 0) + damping);
  r.impulse = e.impulse;
  return r;
}

void Bonds::apply(const Row& r, Moving* bodies, float impulse) {
  bodies[r.a].velocity -= r.inverse_mass_a * impulse * r.axis;
  bodies[r.b].velocity += r.inverse_mass_b * impulse * r.axis;
}

void Bonds::warm_start(Moving* bodies) const {
  for (const Row& r : rows_) apply(r, bodies, r.impulse);
}

void Bonds::sweep(Moving* bodies) {
  for (Row& r : rows_) {
    const float parting = r.axis.dot(bodies[r.a].velocity - bodies[r.b].velocity);
    const float wanted = r.pull + r.drag * parting;
    const float change = (wanted - r.impulse) / (1 + r.drag * (r.inverse_mass_a + r.inverse_mass_b));
    r.impulse += change;
    apply(r, bodies, change);
  }
}

void Bonds::keep_impulses() {
  for (std::size_t k = 0; k < rows_.size(); ++k) entries_[k].impulse = rows_[k].impulse;
}

}  // namespace moraine::impulse
