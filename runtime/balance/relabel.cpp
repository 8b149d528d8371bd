// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/relabel.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace moraine::runtime {
namespace {

constexpr int nobody = -1;

struct Shared {
  double bytes = 0;
  int sub_models = 0;
  int part = 0;
  int rank = 0;
};

/// Speed and memory.
using Kind = std::pair<double, double>;

Kind kind(const BalanceProblem& problem, int rank) {
  return {problem.speed[rank], problem.memory.empty() ? 0.0 : problem.memory[rank]};
}

/// What parts and ranks of the same kind share, most first.
std::vector<Shared> shared_bytes(const BalanceProblem& problem, const Owners& plan) {
  std::map<std::pair<int, int>, Shared> table;
  for (SubModelId s = 0; s < problem.size(); ++s) {
    if (kind(problem, plan[s]) != kind(problem, problem.owner[s])) continue;
    Shared& shared = table[{plan[s], problem.owner[s]}];
    shared = {shared.bytes + problem.bytes[s], shared.sub_models + 1, plan[s], problem.owner[s]};
  }
  std::vector<Shared> list;
  for (const auto& [key, shared] : table) list.push_back(shared);
  std::stable_sort(list.begin(), list.end(), [](const Shared& x, const Shared& y) {
    return std::tie(x.bytes, x.sub_models) > std::tie(y.bytes, y.sub_models);
  });
  return list;
}

class Matching {
 public:
  explicit Matching(const BalanceProblem& problem)
      : problem_(problem), rank_(problem.ranks(), nobody), taken_(problem.ranks(), false) {}

  void match(int part, int rank) {
    if (rank_[part] != nobody || taken_[rank]) return;
    rank_[part] = rank;
    taken_[rank] = true;
  }

  /// The rest keep their labels where these are free.
  void complete() {
    for (int part = 0; part < problem_.ranks(); ++part) match(part, part);
    std::map<Kind, std::vector<int>> free;
    for (int rank = problem_.ranks() - 1; rank >= 0; --rank)
      if (!taken_[rank]) free[kind(problem_, rank)].push_back(rank);
    for (int part = 0; part < problem_.ranks(); ++part) {
      if (rank_[part] != nobody) continue;
      std::vector<int>& ranks = free[kind(problem_, part)];
      match(part, ranks.back());
      ranks.pop_back();
    }
  }

  int rank(int part) const { return rank_[part]; }

 private:
  const BalanceProblem& problem_;
  std::vector<int> rank_;    ///< per part
  std::vector<bool> taken_;  ///< per rank
};

}  // namespace

Owners relabel(const BalanceProblem& problem, const Owners& plan) {
  Matching matching(problem);
  for (const Shared& shared : shared_bytes(problem, plan)) matching.match(shared.part, shared.rank);
  matching.complete();
  Owners owners(plan.size());
  std::transform(plan.begin(), plan.end(), owners.begin(), [&](int part) { return matching.rank(part); });
  return owners;
}

}  // namespace moraine::runtime
