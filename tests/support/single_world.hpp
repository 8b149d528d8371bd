// SPDX-License-Identifier: Apache-2.0
// One world of an engine that holds a whole scene. It takes the scene's steps, in as many substeps as the engine needs.
#pragma once

#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ghosting/model.hpp"
#include "physics/world.hpp"

namespace moraine::test {

class SingleWorld {
 public:
  /// `order`: in which the elements (by index) and then the bonds between them are added; empty: as in the scene.
  /// `features`: what the engine is told that the scene uses; empty: what it does use.
  SingleWorld(const Engine& engine, Scene scene, std::vector<std::uint32_t> order = {}, Limits limits = {},
              std::optional<Features> features = {})
      : scene_(std::move(scene)),
        settings_(world_settings(scene_)),
        substeps_(static_cast<int>(std::ceil(scene_.time.dt / (0.5 * engine.step_limit(scene_).substep)))) {
    substeps_ = std::max(substeps_, scene_.time.substeps);
    settings_.substep = scene_.time.dt / substeps_;
    settings_.limits = limits;
    settings_.features = features.value_or(settings_.features);
    Bounds box;
    for (const Element& e : scene_.elements) box.add(e.state.pose.position);
    world_ = engine.make(settings_, box.empty() ? Vec3::Zero() : box.min);
    if (order.empty()) {
      order.resize(scene_.elements.size());
      std::iota(order.begin(), order.end(), 0U);
    }
    for (const std::uint32_t i : order) add(scene_.elements[i], Role::real);
    for (std::uint32_t b = 0; b < scene_.bonds.size(); ++b)
      world_->add_bond(b, slots_.at(scene_.bonds[b].a), slots_.at(scene_.bonds[b].b));
  }
  /// A world with the same settings and nothing in it.
  SingleWorld(const Engine& engine, const SingleWorld& like)
      : scene_(like.scene_),
        settings_(like.settings_),
        substeps_(like.substeps_),
        slots_(like.slots_),
        done_(like.done_) {
    settings_.scene = &scene_;
    Bounds box;
    for (const Element& e : scene_.elements) box.add(e.state.pose.position);
    world_ = engine.make(settings_, box.empty() ? Vec3::Zero() : box.min);
  }
  SingleWorld(const SingleWorld&) = delete;
  SingleWorld& operator=(const SingleWorld&) = delete;

  Slot add(const Element& e, Role role) {
    return slots_[e.id] = world_->add({e.id, e.shape, e.material, e.mass, role, e.state});
  }
  void steps(int count) { substeps(count * substeps_); }
  void substeps(int count) {
    for (int i = 0; i < count; ++i) {
      world_->step(static_cast<double>(done_++) * settings_.substep);
      given_ += world_->boundary_impulse();
    }
  }

  World& world() { return *world_; }
  const Scene& scene() const { return scene_; }
  Slot slot(ElementId id) const { return slots_.at(id); }
  double step() const { return scene_.time.dt; }
  double substep() const { return settings_.substep; }
  int substeps_per_step() const { return substeps_; }
  /// By boundaries since the start.
  const Impulse& given() const { return given_; }
  ElementState state(ElementId id) const { return world_->state(slots_.at(id)); }
  Vec3 position(ElementId id) const { return state(id).pose.position; }
  Vec3 velocity(ElementId id) const { return state(id).twist.linear; }
  std::vector<ElementId> ids() const {
    std::vector<ElementId> out;
    for (const auto& [id, slot] : slots_) out.push_back(id);
    return out;
  }

 private:
  const Scene scene_;
  WorldSettings settings_;
  int substeps_ = 1;
  std::unique_ptr<World> world_;
  std::map<ElementId, Slot> slots_;
  std::int64_t done_ = 0;
  Impulse given_;
};

inline bool same_bits(const ElementState& a, const ElementState& b) {
  return a.pose.position == b.pose.position && a.pose.orientation.coeffs() == b.pose.orientation.coeffs() &&
         a.twist.linear == b.twist.linear && a.twist.angular == b.twist.angular;
}

}  // namespace moraine::test
