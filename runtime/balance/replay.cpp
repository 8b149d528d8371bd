// SPDX-License-Identifier: Apache-2.0
// Owners given beforehand, one list for each turn.
#include <utility>

#include "runtime/balance/policies.hpp"

namespace moraine::runtime {
namespace {

class Replay final : public Balancer {
 public:
  explicit Replay(std::vector<Owners> plans) : plans_(std::move(plans)) {}

  Owners plan(const BalanceProblem& problem) const override {
    const auto turn = static_cast<std::size_t>(problem.turn);
    return turn < plans_.size() ? plans_[turn] : problem.owner;
  }

 private:
  std::vector<Owners> plans_;
};

}  // namespace

std::unique_ptr<Balancer> make_replay(const BalancerOptions& options) {
  return std::make_unique<Replay>(options.plans);
}

}  // namespace moraine::runtime
