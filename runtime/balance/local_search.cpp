// SPDX-License-Identifier: Apache-2.0
#include "runtime/balance/local_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "runtime/balance/assignment.hpp"
#include "runtime/balance/neighbours.hpp"

namespace moraine::runtime {
namespace {

constexpr double even_enough = 1.02;  // times an even spread
constexpr double worth_a_step = 0.01;

/// `out` moves to a rank, which may give `back` in return.
struct Step {
  SubModelId out = 0;
  int to = 0;
  std::optional<SubModelId> back;
};

/// Less is better.
struct Score {
  double level = 0;    ///< longer time of both ranks, in whole steps worth taking
  double traffic = 0;  ///< bytes until the next turn
  bool swap = false;
  bool operator<(const Score& other) const {
    return std::tie(level, traffic, swap) < std::tie(other.level, other.traffic, other.swap);
  }
};

class Search {
 public:
  Search(const BalanceProblem& problem, const Owners& owners)
      : problem_(problem), neighbours_(problem), state_(problem, owners) {
    const double load = std::accumulate(problem.load.begin(), problem.load.end(), 0.0);
    even_ = load / std::accumulate(problem.speed.begin(), problem.speed.end(), 0.0);
  }

  Owners run() {
    while (state_.makespan() > even_enough * even_) {
      from_ = state_.slowest();
      best_ = {.level = level(state_.makespan())};
      step_.reset();
      for (const SubModelId out : state_.members(from_)) consider_all(out);
      if (!step_) break;
      state_.move(step_->out, step_->to);
      if (step_->back) state_.move(*step_->back, from_);
    }
    return state_.owners();
  }

 private:
  void consider_all(SubModelId out) {
    for (int to = 0; to < problem_.ranks(); ++to) {
      if (to == from_) continue;
      consider({out, to, std::nullopt});
      for (const SubModelId back : state_.members(to)) consider({out, to, back});
    }
  }

  void consider(const Step& step) {
    const double given = problem_.load[step.out] - (step.back ? problem_.load[*step.back] : 0.0);
    const double longer = std::max(state_.time_with(from_, -given), state_.time_with(step.to, given));
    Score score{.level = level(longer), .swap = step.back.has_value()};
    // A step must reach a lower level; only then is its traffic worth counting.
    if (step_ ? score.level > best_.level : score.level >= best_.level) return;
    score.traffic = traffic(step);
    if ((step_ && !(score < best_)) || !has_room(step)) return;
    best_ = score;
    step_ = step;
  }

  double level(double time) const { return std::floor(time / (worth_a_step * even_)); }

  bool has_room(const Step& step) const {
    const double given = problem_.bytes[step.out] - (step.back ? problem_.bytes[*step.back] : 0.0);
    return given > 0 ? state_.has_room(step.to, given) : given == 0 || state_.has_room(from_, -given);
  }

  double traffic(const Step& step) const {
    const double out = traffic_of_move(step.out, step.to);
    return step.back ? out + traffic_of_move(*step.back, from_) + still_cut(step.out, *step.back) : out;
  }

  /// Bytes of a move, less what it saves in messages.
  double traffic_of_move(SubModelId s, int to) const {
    const int here = state_.owners()[s];
    const double moved = problem_.bytes[s] * ((to != problem_.owner[s]) - (here != problem_.owner[s]));
    const double saved =
        neighbours_.bytes_with(state_.owners(), s, to) - neighbours_.bytes_with(state_.owners(), s, here);
    return moved - problem_.costs.rounds * saved;
  }

  /// What the two moves of a swap wrongly expect to save: the messages between the swapped.
  double still_cut(SubModelId out, SubModelId back) const {
    for (const Neighbour& neighbour : neighbours_.of(out))
      if (neighbour.id == back) return 2 * problem_.costs.rounds * neighbour.bytes;
    return 0;
  }

  const BalanceProblem& problem_;
  Neighbours neighbours_;
  Assignment state_;
  double even_ = 0;
  int from_ = 0;
  Score best_;
  std::optional<Step> step_;
};

}  // namespace

Owners local_search(const BalanceProblem& problem, const Owners& owners) { return Search(problem, owners).run(); }

}  // namespace moraine::runtime
