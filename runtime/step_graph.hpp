// SPDX-License-Identifier: Apache-2.0
// Stages x sub-models x neighbours of one round, as plain data. Every round of an epoch has the same graph.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

/// A (sub-model, stage) pair: place of the sub-model * stage count + stage.
using NodeId = std::uint32_t;

/// A node in one round. Rounds count from 0, the opening round of the epoch.
struct Task {
  NodeId node = 0;
  std::int64_t round = 0;
  bool operator==(const Task&) const = default;
};

/// `to` may start once `from` is done: of the same round, or of the round before.
struct Link {
  NodeId from = 0;
  NodeId to = 0;
  bool next_round = false;
  auto operator<=>(const Link&) const = default;
};

/// Successors of every node, one list after another.
struct Successors {
  std::vector<std::uint32_t> first;
  std::vector<NodeId> nodes;
  std::span<const NodeId> of(NodeId node) const {
    return std::span(nodes).subspan(first[node], first[node + 1] - first[node]);
  }
};

struct StepGraph {
  std::size_t sub_models = 0;       ///< in this graph: those held here
  std::vector<SubModelId> ids;      ///< by place, ascending
  std::vector<std::string> stages;  ///< names
  bool awaits_messages = false;     ///< some predecessors are messages from elsewhere
  Successors same_round;
  Successors next_round;
  std::vector<std::uint32_t> predecessors;          ///< per node, in every round but the first
  std::vector<std::uint32_t> opening_predecessors;  ///< per node, in the opening round: nothing precedes it
  std::vector<double> cost;                         ///< predicted, per node, any unit

  std::size_t node_count() const { return sub_models * stages.size(); }
  NodeId node(std::size_t place, int stage) const {
    return static_cast<NodeId>(place * stages.size() + static_cast<std::size_t>(stage));
  }
  std::size_t place(NodeId node) const { return node / stages.size(); }
  /// Of a sub-model held here.
  std::size_t place_of(SubModelId id) const {
    return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  }
  SubModelId sub_model(NodeId node) const { return ids[place(node)]; }
  int stage(NodeId node) const { return static_cast<int>(node % stages.size()); }
};

/// Adds to `links` that a sub-model runs its stages in order, and sorts all into a graph of sub-models 0, 1, ....
/// `cost` has one value per node; if none is positive, all nodes are taken to cost the same. Errors: std::logic_error
/// for a link within a round that does not lead to a later stage. Cost: sorts the links.
StepGraph assemble_graph(std::vector<std::string> stages, std::size_t sub_models, std::vector<Link> links,
                         std::vector<double> cost);

/// The graph of the sub-models held here with their present neighbours, and counted work as cost. Messages from
/// elsewhere count as predecessors. A message within this process has two slots, used by turns, so a link back keeps a
/// sender from overwriting what its receiver has yet to read, wherever the other messages do not. Errors:
/// std::logic_error if sources and targets do not mirror each other, are not ascending, or a stage has two receivers.
StepGraph build_step_graph(Model& model);

}  // namespace moraine::runtime
