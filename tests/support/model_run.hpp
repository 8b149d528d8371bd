// SPDX-License-Identifier: Apache-2.0
// Runs scenes as the command does, without its files, and says what came of it.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ghosting/model.hpp"
#include "ghosting/state_hash.hpp"
#include "runtime/simulation.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine::test {

/// A scene of apps/scenes.
inline Scene example(const std::string& name, const std::vector<Override>& overrides = {}) {
  return read_scene(std::string(MORAINE_SOURCE_DIR) + "/apps/scenes/" + name + ".yaml", overrides);
}

/// A scene cut, ready to run, and observed between steps.
class ModelRun {
 public:
  using Look = std::function<void(const CoupledModel&)>;

  explicit ModelRun(Scene scene, int threads = 1, const std::string& scheduler = "serial", Look each_epoch = {})
      : scene_(std::move(scene)),
        model_(scene_),
        simulation_(model_,
                    {.threads = threads, .scheduler = scheduler, .measured_cost = false, .check_messages = true},
                    {.until_next_stop = {}, .at_epoch_end = [this, each_epoch](std::int64_t) {
                       if (each_epoch) each_epoch(model_);
                     }}) {}

  void steps(std::int64_t count) {
    const std::int64_t rounds = count * scene_.time.substeps;
    simulation_.run(rounds_, rounds);
    rounds_ += rounds;
  }
  /// All the steps that the scene asks for.
  ModelRun& go() {
    steps(scene_.time.steps);
    return *this;
  }

  /// The end of the run, as guards see it.
  void conclude() { model_.conclude(rounds_); }

  const Scene& scene() const { return scene_; }
  const CoupledModel& model() const { return model_; }
  runtime::SubModel& part(std::size_t i) { return model_.sub_model(static_cast<SubModelId>(i)); }
  double time() const { return static_cast<double>(rounds_) * scene_.time.substep(); }
  std::uint64_t hash() const { return state_hash(scene_, model_.states()); }
  ElementState of(ElementId id) const {
    const std::vector<ElementState> all = model_.states();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (scene_.elements[i].id == id) return all[i];
    throw InputError("no such element");
  }
  Vec3 position(ElementId id) const { return of(id).pose.position; }
  Vec3 velocity(ElementId id) const { return of(id).twist.linear; }
  Vec3 spin(ElementId id) const { return of(id).twist.angular; }
  double kinetic_energy() const { return model_.statistics().ledger.kinetic_energy; }
  /// What boundaries gave to the elements in the last substep [N s].
  Vec3 boundary_impulse() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < model_.size(); ++p) sum += model_.part(p).world().boundary_impulse().linear;
    return sum;
  }

 private:
  const Scene scene_;
  CoupledModel model_;
  runtime::Simulation simulation_;
  std::int64_t rounds_ = 0;
};

inline Override set(const std::string& key, const std::string& value) { return {key, value}; }
inline Override set(const std::string& key, double value) { return {key, fmt::format("{:.17g}", value)}; }

}  // namespace moraine::test
