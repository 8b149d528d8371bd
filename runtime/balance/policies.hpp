// SPDX-License-Identifier: Apache-2.0
// The factories of all balancers, for their table.
#pragma once

#include <memory>

#include "runtime/balance/registry.hpp"

namespace moraine::runtime {

std::unique_ptr<Balancer> make_keep(const BalancerOptions&);
std::unique_ptr<Balancer> make_greedy(const BalancerOptions&);
std::unique_ptr<Balancer> make_refine(const BalancerOptions&);
std::unique_ptr<Balancer> make_diffusion(const BalancerOptions&);
std::unique_ptr<Balancer> make_graph(const BalancerOptions&);
std::unique_ptr<Balancer> make_rotate(const BalancerOptions&);
std::unique_ptr<Balancer> make_replay(const BalancerOptions&);

}  // namespace moraine::runtime
