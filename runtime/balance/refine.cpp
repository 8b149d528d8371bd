// SPDX-License-Identifier: Apache-2.0
// Few moves and swaps from the busiest rank.
#include "runtime/balance/policies.hpp"
#include "runtime/balance/refinement.hpp"

namespace moraine::runtime {
namespace {

class Refine final : public Balancer {
 public:
  Owners plan(const BalanceProblem& problem) const override { return refined(problem, problem.owner); }
};

}  // namespace

std::unique_ptr<Balancer> make_refine(const BalancerOptions&) { return std::make_unique<Refine>(); }

}  // namespace moraine::runtime
