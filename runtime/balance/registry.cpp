// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/registry.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string>

#include "runtime/balance/policies.hpp"

namespace moraine::runtime {
namespace {

constexpr std::array table{
    BalancerRow{"none", "sub-models stay where they are", false, make_keep},
    BalancerRow{"greedy", "anew from nothing, the largest first, each to the rank that is done with it first", false,
                make_greedy},
    BalancerRow{"refine", "few moves and swaps from the busiest rank while that helps", false, make_refine},
    BalancerRow{"diffusion", "work flows between ranks that own neighbours, by sub-models at their border", false,
                make_diffusion},
    BalancerRow{"graph", "keeps neighbours together and moves little: Scotch's graph mapping, then refine", false,
                make_graph},
    BalancerRow{"rotate", "for tests: every sub-model goes to the next rank each time", true, make_rotate},
    BalancerRow{"replay", "for tests: owners given beforehand, in order", true, make_replay},
};

}  // namespace

std::span<const BalancerRow> balancers() { return table; }

const BalancerRow& find_balancer(std::string_view name) {
  std::string known;
  for (const BalancerRow& row : table) {
    if (row.name == name) return row;
    known += fmt::format("\n  {:<14} {}", row.name, row.help);
  }
  throw std::invalid_argument(fmt::format("no balancer is called '{}'; there are:{}", name, known));
}

}  // namespace moraine::runtime
