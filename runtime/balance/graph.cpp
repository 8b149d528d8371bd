// SPDX-License-Identifier: Apache-2.0
// Keeps neighbours together and moves little: Scotch maps the graph of sub-models to ranks anew with regard to present
// owners (Fourestier & Pellegrini 2011, "Adaptation au repartitionnement de graphes d'une methode d'optimisation
// globale par diffusion"), then refinement evens out what is left.
#include <scotch.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "runtime/balance/decision.hpp"
#include "runtime/balance/neighbours.hpp"
#include "runtime/balance/policies.hpp"
#include "runtime/balance/refinement.hpp"
#include "runtime/balance/relabel.hpp"

namespace moraine::runtime {
namespace {

using Numbers = std::vector<SCOTCH_Num>;

// Scotch counts in whole numbers: what all amounts of a kind add up to.
constexpr double total_load = 1e7;
constexpr double total_bytes = 1e8;
constexpr double total_speed = 1e6;
constexpr double allowed_imbalance = 0.02;
constexpr SCOTCH_Num seed = 1;

void require(int status) {
  if (status != 0) throw std::runtime_error("balancer graph: Scotch failed; its message is on standard error");
}

SCOTCH_Num whole(double amount) { return std::max<SCOTCH_Num>(1, static_cast<SCOTCH_Num>(std::llround(amount))); }

Numbers whole_shares(const std::vector<double>& amounts, double total) {
  const double all = sum(amounts);
  Numbers shares;
  for (const double amount : amounts) shares.push_back(whole(all > 0 ? amount / all * total : 1.0));
  return shares;
}

/// The graph in Scotch's form: messages and moves in the same unit, bytes until the next turn.
struct Graph {
  Numbers first{0}, neighbour, messages;
  Numbers load, move;

  explicit Graph(const BalanceProblem& problem) : load(whole_shares(problem.load, total_load)) {
    const double scale = total_bytes / bytes_at_stake(problem);
    const Neighbours neighbours(problem);
    for (SubModelId s = 0; s < problem.size(); ++s) {
      for (const Neighbour& n : neighbours.of(s)) {
        neighbour.push_back(static_cast<SCOTCH_Num>(n.id));
        messages.push_back(whole(n.bytes * problem.costs.rounds * scale));
      }
      first.push_back(static_cast<SCOTCH_Num>(neighbour.size()));
      move.push_back(whole(problem.bytes[s] * scale));
    }
  }

 private:
  static double bytes_at_stake(const BalanceProblem& problem) {
    double bytes = sum(problem.bytes);
    for (const Traffic& traffic : problem.traffic) bytes += problem.costs.rounds * traffic.bytes;
    return std::max(bytes, 1.0);
  }
};

/// One of Scotch's objects, released when it goes out of scope.
template <class T, int (*init)(T*), void (*exit)(T*)>
class Handle {
 public:
  Handle() { require(init(&object_)); }
  ~Handle() { exit(&object_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  T* get() { return &object_; }

 private:
  T object_;
};

using Context = Handle<SCOTCH_Context, SCOTCH_contextInit, SCOTCH_contextExit>;
using ScotchGraph = Handle<SCOTCH_Graph, SCOTCH_graphInit, SCOTCH_graphExit>;
using Architecture = Handle<SCOTCH_Arch, SCOTCH_archInit, SCOTCH_archExit>;
using Strategy = Handle<SCOTCH_Strat, SCOTCH_stratInit, SCOTCH_stratExit>;

/// One thread and random numbers of its own, always the same: every rank gets the same answer.
void make_repeatable(Context& context) {
  require(SCOTCH_contextRandomClone(context.get()));
  SCOTCH_contextRandomSeed(context.get(), seed);
  SCOTCH_contextRandomReset(context.get());
  require(SCOTCH_contextOptionSetNum(context.get(), SCOTCH_OPTIONNUMDETERMINISTIC, 1));
  require(SCOTCH_contextThreadSpawn(context.get(), 1, nullptr));
}

Owners map_graph(const BalanceProblem& problem) {
  Graph data(problem);
  const Numbers speed = whole_shares(problem.speed, total_speed);
  Context context;
  make_repeatable(context);
  ScotchGraph plain, graph;
  require(SCOTCH_graphBuild(plain.get(), 0, static_cast<SCOTCH_Num>(problem.size()), data.first.data(), nullptr,
                            data.load.data(), nullptr, data.first.back(), data.neighbour.data(), data.messages.data()));
  require(SCOTCH_contextBindGraph(context.get(), plain.get(), graph.get()));
  Architecture ranks;
  require(SCOTCH_archCmpltw(ranks.get(), problem.ranks(), speed.data()));
  Strategy strategy;
  require(SCOTCH_stratGraphMapBuild(strategy.get(), SCOTCH_STRATQUALITY | SCOTCH_STRATRECURSIVE | SCOTCH_STRATREMAP,
                                    problem.ranks(), allowed_imbalance));
  Numbers present(problem.owner.begin(), problem.owner.end()), mapped(problem.size(), 0);
  require(SCOTCH_graphRemap(graph.get(), ranks.get(), present.data(), 1.0, data.move.data(), strategy.get(),
                            mapped.data()));
  return Owners(mapped.begin(), mapped.end());
}

class GraphMapping final : public Balancer {
 public:
  Owners plan(const BalanceProblem& problem) const override {
    if (problem.size() == 0 || problem.ranks() == 1) return problem.owner;
    const Owners mapped = refined(problem, relabel(problem, map_graph(problem)));
    // Scotch knows of no memory limits.
    return fits_memory(problem, mapped) ? mapped : refined(problem, problem.owner);
  }
};

}  // namespace

std::unique_ptr<Balancer> make_graph(const BalancerOptions&) { return std::make_unique<GraphMapping>(); }

}  // namespace moraine::runtime
