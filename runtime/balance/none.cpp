// SPDX-License-Identifier: Apache-2.0
// Sub-models stay where they are.
#include "runtime/balance/policies.hpp"

namespace moraine::runtime {
namespace {

class Keep final : public Balancer {
 public:
  Owners plan(const BalanceProblem& problem) const override { return problem.owner; }
};

}  // namespace

std::unique_ptr<Balancer> make_keep(const BalancerOptions&) { return std::make_unique<Keep>(); }

}  // namespace moraine::runtime
