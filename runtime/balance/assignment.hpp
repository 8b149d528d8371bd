// SPDX-License-Identifier: Apache-2.0
// Owners that change move by move, and what each rank then has.
#pragma once

#include <span>
#include <vector>

#include "runtime/balance/balancer.hpp"

namespace moraine::runtime {

class Assignment {
 public:
  /// `problem` must outlive it.
  Assignment(const BalanceProblem& problem, Owners owners);
  void move(SubModelId s, int to);

  const Owners& owners() const { return owners_; }
  /// Sub-models of a rank, ascending.
  std::span<const SubModelId> members(int rank) const { return members_[rank]; }
  double time(int rank) const { return time_[rank]; }
  /// Time of a rank with so much more load than it has.
  double time_with(int rank, double more) const { return time_[rank] + more / problem_.speed[rank]; }
  bool has_room(int rank, double more_bytes) const;
  int slowest() const;
  double makespan() const { return time_[slowest()]; }

 private:
  void sum_up(int rank);

  const BalanceProblem& problem_;
  Owners owners_;
  std::vector<std::vector<SubModelId>> members_;
  std::vector<double> time_;   ///< per rank, summed in the order of sub-models whatever the order of moves
  std::vector<double> bytes_;  ///< per rank
};

}  // namespace moraine::runtime
