// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/neighbours.hpp"

#include <numeric>

namespace moraine::runtime {

Neighbours::Neighbours(const BalanceProblem& problem)
    : first_(problem.size() + std::size_t{1}, 0), list_(2 * problem.traffic.size()) {
  for (const Traffic& t : problem.traffic) {
    ++first_[t.a + 1];
    ++first_[t.b + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::size_t> next = first_;
  // Traffic is sorted by (a, b): a sub-model's lower neighbours come first, and both halves ascend.
  for (const Traffic& t : problem.traffic) list_[next[t.b]++] = {t.a, t.bytes};
  for (const Traffic& t : problem.traffic) list_[next[t.a]++] = {t.b, t.bytes};
}

double Neighbours::bytes_with(const Owners& owners, SubModelId s, int rank) const {
  double sum = 0;
  for (const Neighbour& neighbour : of(s))
    if (owners[neighbour.id] == rank) sum += neighbour.bytes;
  return sum;
}

}  // namespace moraine::runtime
