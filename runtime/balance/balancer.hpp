// SPDX-License-Identifier: Apache-2.0
// The contract of a balancer: which rank should own which sub-model.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

/// The rank of each sub-model.
using Owners = std::vector<int>;

/// What two sub-models send each other in a round, both ways; a < b.
struct Traffic {
  SubModelId a = 0;
  SubModelId b = 0;
  double bytes = 0;
};

/// What a move costs, and how long its gain lasts.
struct BalanceCosts {
  double seconds_per_byte = 0;         ///< moved
  double seconds_per_move = 0;         ///< beside its bytes
  double seconds_per_load = 1;         ///< of a rank of speed 1; 1 if load is given in seconds
  double rounds = 1;                   ///< until owners are settled anew
  double least_imbalance_gain = 0.02;  ///< a smaller fall of max/mean is left alone
};

/// All that a plan may depend on; the same on every rank.
struct BalanceProblem {
  std::vector<double> load;      ///< per sub-model and round: predicted busy seconds or counted work
  std::vector<double> bytes;     ///< per sub-model: its memory, and what has to be moved with it
  std::vector<Traffic> traffic;  ///< ascending by (a, b), each pair once
  Owners owner;                  ///< at present
  std::vector<double> speed;     ///< per rank; 1 is normal, and load / speed is time
  std::vector<double> memory;    ///< per rank: bytes it may own; empty: no limit
  std::int64_t turn = 0;         ///< how many times owners were settled before
  BalanceCosts costs;

  int ranks() const { return static_cast<int>(speed.size()); }
  SubModelId size() const { return static_cast<SubModelId>(load.size()); }
};

/// A pure function of the problem: no clock, no messages, no memory of earlier calls. Ties go to the lower number.
class Balancer {
 public:
  virtual ~Balancer() = default;
  /// New owners of a problem that is well formed. A plan may ask for more memory than ranks have if none else is found.
  virtual Owners plan(const BalanceProblem& problem) const = 0;
};

/// Errors: std::invalid_argument if lists differ in length, numbers are negative or not finite, a rank has no speed,
/// or there is no such owner or sub-model.
void check(const BalanceProblem& problem);

/// Errors: std::invalid_argument unless each sub-model has one of the problem's ranks.
void check_owners(const BalanceProblem& problem, const Owners& owners);

}  // namespace moraine::runtime
