// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/assignment.hpp"

#include <algorithm>
#include <utility>

namespace moraine::runtime {

Assignment::Assignment(const BalanceProblem& problem, Owners owners)
    : problem_(problem),
      owners_(std::move(owners)),
      members_(problem.ranks()),
      time_(problem.ranks(), 0.0),
      bytes_(problem.ranks(), 0.0) {
  for (SubModelId s = 0; s < owners_.size(); ++s) members_[owners_[s]].push_back(s);
  for (int rank = 0; rank < problem.ranks(); ++rank) sum_up(rank);
}

void Assignment::move(SubModelId s, int to) {
  const int from = std::exchange(owners_[s], to);
  std::erase(members_[from], s);
  members_[to].insert(std::lower_bound(members_[to].begin(), members_[to].end(), s), s);
  sum_up(from);
  sum_up(to);
}

bool Assignment::has_room(int rank, double more_bytes) const {
  return problem_.memory.empty() || bytes_[rank] + more_bytes <= problem_.memory[rank];
}

int Assignment::slowest() const {
  return static_cast<int>(std::max_element(time_.begin(), time_.end()) - time_.begin());
}

void Assignment::sum_up(int rank) {
  time_[rank] = bytes_[rank] = 0;
  for (const SubModelId s : members_[rank]) {
    time_[rank] += problem_.load[s];
    bytes_[rank] += problem_.bytes[s];
  }
  time_[rank] /= problem_.speed[rank];
}

}  // namespace moraine::runtime
