// SPDX-License-Identifier: Apache-2.0
// The whole model: a scene cut into sub-models, and what is asked of all of them between epochs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ghosting/split.hpp"
#include "ghosting/sub_model.hpp"

namespace moraine {

/// Counts and residuals of a run so far.
struct ModelStatistics {
  double ghosts_mean = 0;
  std::size_t ghosts_max = 0;
  std::size_t ghosts_now = 0;
  std::size_t bonds_broken = 0;
  std::size_t recuts = 0;
  double linear_residual = 0;    ///< unexplained momentum / larger of the largest sum of m|v| and the impulse exchanged
  double angular_residual = 0;   ///< the same for angular momentum about the world origin
  double coupling_residual = 0;  ///< rms speed by which copies disagreed / sqrt(g d)
  Ledger ledger;
};

/// Overlaps of the present contacts, in element diameters.
struct OverlapStatistics {
  double max = 0;
  double mean = 0;  ///< over contacts that overlap
};

class CoupledModel final : public runtime::Model {
 public:
  /// Cuts the scene as its run settings say. `scene` must outlive the model.
  /// Errors: InputError for unknown names, shapes the engine cannot do, limits that cannot be kept.
  explicit CoupledModel(const Scene& scene);
  ~CoupledModel() override;

  std::span<const runtime::Stage> stages() const override { return SubModel::stages(); }
  std::size_t size() const override { return sub_models_.size(); }
  runtime::SubModel& sub_model(runtime::SubModelId id) override { return *sub_models_[id]; }
  std::int64_t begin_epoch(std::int64_t next_round, std::int64_t at_most) override;

  const Scene& scene() const { return *context_.scene; }
  const SplitRow& split() const { return *split_; }
  const CouplingRow& coupling() const { return *coupling_row_; }
  const SubModel& part(std::size_t i) const { return *sub_models_[i]; }
  /// Canonical state of every element, ascending id.
  std::vector<ElementState> states() const;
  /// Owner of every element, ascending id.
  const std::vector<SubModelId>& owners() const { return owners_; }
  std::vector<std::uint32_t> alive_bonds() const;
  std::size_t ghosts_now() const;
  ModelStatistics statistics() const;
  OverlapStatistics overlaps() const;

 private:
  void cut(std::span<const ElementState> states, std::span<const ContactMemory> memory);
  std::vector<ContactMemory> contact_memory() const;
  std::vector<std::vector<ContactMemory>> by_part(std::span<const ContactMemory> memory) const;
  bool should_recut() const;
  double ghost_share() const;
  void open_epoch();
  void settle_neighbours();
  void note_extremes();
  void take_over_accounts();

  ModelContext context_;
  const CouplingRow* coupling_row_ = nullptr;
  std::unique_ptr<Coupling> coupling_;
  const SplitRow* split_ = nullptr;
  std::size_t parts_ = 1;
  std::vector<std::unique_ptr<SubModel>> sub_models_;
  std::vector<SubModelId> owners_;
  std::int64_t epoch_end_ = 0;   ///< the first round for which neighbours must be settled anew
  double share_after_cut_ = -1;  ///< -1: not known yet
  std::int64_t rounds_done_ = 0, rounds_at_cut_ = 0;

  // Accounts of sub-models of earlier cuts, and extremes between epochs
  ModelStatistics closed_;
  Ledger opening_ledger_;
  double disagreement_closed_ = 0;
  std::uint64_t disagreements_closed_ = 0, ghost_rounds_closed_ = 0, rounds_closed_ = 0;
  std::vector<std::uint32_t> broken_;  ///< ascending
  std::size_t ghosts_max_ = 0;
  double speed_sum_max_ = 0, spin_scale_max_ = 0;
};

/// Units and settings of the worlds a scene needs.
WorldSettings world_settings(const Scene& scene);
Features features_of(const Scene& scene);
/// Limits by profile name ("default", "physx"). Errors: InputError.
Limits find_limits(std::string_view profile);

}  // namespace moraine
