// SPDX-License-Identifier: Apache-2.0
// The whole model: a scene cut into sub-models, and what is asked of all of them between epochs.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ghosting/accounts.hpp"
#include "ghosting/admission.hpp"
#include "ghosting/guards.hpp"
#include "ghosting/split.hpp"
#include "ghosting/sub_model.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine {

/// Overlaps of the present contacts, in element diameters.
struct OverlapStatistics {
  double max = 0;
  double mean = 0;  ///< over contacts that overlap
};

class CoupledModel : public runtime::Model {
 public:
  /// Cuts the scene as its run settings say, and makes the sub-models that this rank owns: blocks of about as many
  /// elements on each rank. `scene` and `transport` must outlive the model. On several ranks all must make one.
  /// Errors: InputError for unknown names, shapes the engine cannot do, limits that cannot be kept.
  explicit CoupledModel(const Scene& scene, runtime::Transport& transport = runtime::alone());
  ~CoupledModel() override;

  std::span<const runtime::Stage> stages() const override { return SubModel::stages(); }
  std::span<const std::string_view> counters() const override { return SubModel::counters(); }
  std::size_t size() const override { return sub_models_.size(); }
  runtime::SubModel& sub_model(runtime::SubModelId id) override { return *sub_models_[id]; }
  runtime::EpochPlan begin_epoch(std::int64_t next_round, std::int64_t at_most) override;
  void save_common(std::vector<std::byte>& out) const override;
  void load_common(std::span<const std::byte> in) override;
  void release(runtime::SubModelId id) override { sub_models_[id].reset(); }
  void adopt(runtime::SubModelId id, std::span<const std::byte> saved) override;

  const Scene& scene() const { return *context_.scene; }
  const Engine& engine() const { return *context_.engine; }
  const SplitRow& split() const { return *split_; }
  const CouplingRow& coupling() const { return *coupling_row_; }
  bool holds(std::size_t i) const { return sub_models_[i] != nullptr; }
  /// One that is held here.
  const SubModel& part(std::size_t i) const { return *sub_models_[i]; }
  /// Owner of every element, ascending id.
  const std::vector<SubModelId>& owners() const { return owners_; }

  /// When neighbours were settled last.
  std::uint64_t ghosts_at_epoch() const { return ghosts_at_epoch_; }

  /// Texts of guards that warned for the first time since this was asked last.
  std::vector<std::string> take_news() { return guard_log_.take_news(); }
  /// All that guards warned of, with how often.
  std::vector<std::string> warnings() const { return guard_log_.warnings(context_); }

  // The following are collective.

  /// At the end of a run, after `round` rounds: what an epoch begins with. Errors: InvalidStateError, on all ranks.
  void conclude(std::int64_t round);

  /// Canonical state of every element, ascending id; on all ranks, or on `root` alone (nothing elsewhere).
  std::vector<ElementState> states(std::optional<int> root = std::nullopt) const;
  std::vector<std::uint32_t> alive_bonds() const;
  /// After `round` rounds of the run; without them there is no mean force on boundaries.
  ModelStatistics statistics(std::int64_t round = 0) const;
  OverlapStatistics overlaps() const;

 private:
  std::vector<ElementState> own_states() const;
  void cut(std::span<const ElementState> states, std::span<const ContactMemory> memory);
  std::vector<ContactMemory> contact_memory() const;
  std::vector<std::vector<ContactMemory>> by_part(std::span<const ContactMemory> memory) const;
  void open_epoch();
  /// Boundary forces are averaged from there on.
  std::int64_t marked_round() const;
  /// Takes account of everything, and lets the guards look. Errors: InvalidStateError, on all ranks.
  std::vector<Report> look(std::int64_t round, double overlap = 0);
  Watch watch(const std::vector<Report>& now, double overlap);
  double speed_unit() const;  ///< sqrt(g d) [m/s]
  bool should_recut() const;
  double ghost_share() const;
  void settle_neighbours(const std::vector<Report>& reports);
  std::vector<std::uint32_t> alive_bonds(const std::vector<Report>& reports) const;
  std::vector<Report> reports() const;

  runtime::Transport& transport_;
  ModelContext context_;
  const CouplingRow* coupling_row_ = nullptr;
  std::unique_ptr<Coupling> coupling_;
  const SplitRow* split_ = nullptr;
  std::size_t parts_ = 1;
  std::vector<std::unique_ptr<SubModel>> sub_models_;  ///< none where another rank owns it

  // The same on every rank
  std::vector<SubModelId> owners_;
  std::int64_t epoch_begin_ = 0;
  std::int64_t epoch_end_ = 0;   ///< the first round for which neighbours must be settled anew
  double share_after_cut_ = -1;  ///< -1: not known yet
  std::int64_t rounds_at_cut_ = 0;
  std::uint64_t ghosts_at_epoch_ = 0;
  Accounts accounts_;
  GuardLog guard_log_;
};

/// Units and settings of the worlds a scene needs.
WorldSettings world_settings(const Scene& scene);
Features features_of(const Scene& scene);

}  // namespace moraine
