// SPDX-License-Identifier: Apache-2.0
// Owners from nothing, the largest sub-model first: even, but neighbours are spread and much is moved.
#include "runtime/balance/longest_first.hpp"
#include "runtime/balance/policies.hpp"

namespace moraine::runtime {
namespace {

class Greedy final : public Balancer {
 public:
  Owners plan(const BalanceProblem& problem) const override { return longest_first(problem); }
};

}  // namespace

std::unique_ptr<Balancer> make_greedy(const BalancerOptions&) { return std::make_unique<Greedy>(); }

}  // namespace moraine::runtime
