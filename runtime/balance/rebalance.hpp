// SPDX-License-Identifier: Apache-2.0
// Balancing a run: what sub-models cost is collected from all ranks, a plan is made, and carried out if it pays.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/balance/decision.hpp"
#include "runtime/balance/load_model.hpp"
#include "runtime/balance/registry.hpp"
#include "runtime/epoch.hpp"
#include "runtime/trace/load.hpp"
#include "runtime/trace/trace.hpp"
#include "runtime/transport/mail.hpp"

namespace moraine::runtime {

struct BalanceOptions {
  std::string balancer = "refine";  ///< a name of balancers()
  std::string predictor = "last";   ///< a name of predictors()
  std::int64_t every = 1;           ///< rounds from one balance to the next, at least
  bool measured = false;            ///< load is processor time, not counted work: plans then differ from run to run
  BalancerOptions more;
};

class Rebalance {
 public:
  /// Errors: std::invalid_argument for unknown names.
  Rebalance(const BalanceOptions& options, Transport& transport);

  /// What an epoch cost here. `sent` as of Mail::sent().
  void note(Model& model, const Epoch& epoch, const LoadRecord& load, const std::vector<Mail::Sent>& sent);
  /// Called by all ranks between the settling of neighbours and the first round. Does nothing with one rank, or when
  /// the last balance is not long enough ago. Cost: one exchange of a record per sub-model and neighbour pair.
  void settle(Model& model, std::int64_t next_round);

  /// All ranks have the same, but for the time it took. Their epoch is not filled in.
  const std::vector<BalanceRoundRecord>& records() const { return records_; }
  /// Of the last settle(); none if it did nothing.
  const std::vector<MoveRecord>& last_moves() const { return last_moves_; }
  std::int64_t migrations() const;

  /// For checkpoints: all that plans depend on. The same on every rank.
  void save(std::vector<std::byte>& out) const;
  void load(std::span<const std::byte>& in);

 private:
  /// A sub-model since the last collection.
  struct Cost {
    SubModelId id = 0;
    std::uint32_t unused = 0;
    double load = 0;     ///< sum over rounds
    double seconds = 0;  ///< of processors
    double memory = 0;
    double rounds = 0;
  };
  /// What every rank tells of its own.
  struct Collected {
    std::vector<Cost> costs;       ///< ascending id
    std::vector<Traffic> traffic;  ///< ascending (a, b), per round
  };

  Collected collect(Model& model);
  double measured_imbalance(const std::vector<Cost>& costs, const std::vector<int>& owner) const;
  void carry_out(Model& model, const Owners& plan, BalanceRoundRecord& record);
  BalanceProblem problem(const Collected& all, const std::vector<int>& owner) const;

  BalanceOptions options_;
  Transport& transport_;
  const BalancerRow& row_;
  const PredictorRow& predictor_;
  std::unique_ptr<Balancer> balancer_;
  std::vector<Cost> costs_;       ///< per sub-model of the whole model; of others, nothing
  std::vector<Traffic> traffic_;  ///< sent from here since the last collection
  double rounds_ = 0;             ///< since the last collection
  std::vector<LoadHistory> histories_;
  std::int64_t last_round_ = 0, turn_ = 0;
  std::vector<BalanceRoundRecord> records_;
  std::vector<MoveRecord> last_moves_;
};

}  // namespace moraine::runtime
