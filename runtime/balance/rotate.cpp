// SPDX-License-Identifier: Apache-2.0
// Every sub-model goes to the next rank: the most moves there can be.
#include "runtime/balance/policies.hpp"

namespace moraine::runtime {
namespace {

class Rotate final : public Balancer {
 public:
  Owners plan(const BalanceProblem& problem) const override {
    Owners next = problem.owner;
    for (int& rank : next) rank = (rank + 1) % problem.ranks();
    return next;
  }
};

}  // namespace

std::unique_ptr<Balancer> make_rotate(const BalancerOptions&) { return std::make_unique<Rotate>(); }

}  // namespace moraine::runtime
