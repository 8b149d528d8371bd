// SPDX-License-Identifier: Apache-2.0
// The table of balancers.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

/// What balancers other than those that look at loads need.
struct BalancerOptions {
  std::vector<Owners> plans;  ///< for replay: one for each turn; owners are kept after the last
};

struct BalancerRow {
  std::string_view name;
  std::string_view help;  ///< one line
  bool forced;            ///< its plans are carried out whether or not they pay
  std::unique_ptr<Balancer> (*make)(const BalancerOptions& options);
};

std::span<const BalancerRow> balancers();

/// Errors: std::invalid_argument, listing the table, if there is none of that name.
const BalancerRow& find_balancer(std::string_view name);

}  // namespace moraine::runtime
