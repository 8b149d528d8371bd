// SPDX-License-Identifier: Apache-2.0
#include "runtime/step_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "runtime/message_plan.hpp"

namespace moraine::runtime {
namespace {

void add_own_order(const StepGraph& graph, std::vector<Link>& links) {
  const int last = static_cast<int>(graph.stages.size()) - 1;
  for (std::size_t s = 0; s < graph.sub_models; ++s) {
    for (int stage = 0; stage < last; ++stage) links.push_back({graph.node(s, stage), graph.node(s, stage + 1), false});
    if (last >= 0) links.push_back({graph.node(s, last), graph.node(s, 0), true});
  }
}

void check_forward(const StepGraph& graph, const std::vector<Link>& links) {
  for (const Link& link : links) {
    if (link.from >= graph.node_count() || link.to >= graph.node_count())
      throw std::logic_error(fmt::format("link {} -> {} leaves the graph", link.from, link.to));
    if (!link.next_round && graph.stage(link.from) >= graph.stage(link.to))
      throw std::logic_error(fmt::format("link {} -> {} does not lead to a later stage", link.from, link.to));
  }
}

Successors successors_of(std::size_t nodes, const std::vector<Link>& sorted, bool next_round) {
  Successors out;
  out.first.assign(nodes + 1, 0);
  for (const Link& link : sorted) {
    if (link.next_round != next_round) continue;
    ++out.first[link.from + 1];
    out.nodes.push_back(link.to);
  }
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  return out;
}

void count_predecessors(StepGraph& graph) {
  graph.opening_predecessors.assign(graph.node_count(), 0);
  for (const NodeId to : graph.same_round.nodes) ++graph.opening_predecessors[to];
  graph.predecessors = graph.opening_predecessors;
  for (const NodeId to : graph.next_round.nodes) ++graph.predecessors[to];
}

bool contains(std::span<const SubModelId> ids, SubModelId id) { return std::binary_search(ids.begin(), ids.end(), id); }

/// Whether the messages from the receiver back to the sender already keep the sender from overrunning. Positions count
/// stages from the start of the round in which the message is sent. The message is read at `read`; the slot is written
/// again at `write`. Some message back must leave after the reading and be awaited before the writing.
bool reading_is_awaited(Model& model, const Message& message, int read, int write) {
  const auto stages = model.stages();
  const int count = static_cast<int>(stages.size());
  for (int t = 0; t < count; ++t) {
    const int s = stages[static_cast<std::size_t>(t)].receives;
    if (s == Stage::none || !contains(model.sub_model(message.from).sources(t), message.to)) continue;
    const int rounds_after = std::max(0, (read - s + count - 1) / count);
    const int awaited = (rounds_after + (s < t ? 0 : 1)) * count + t;
    if (awaited <= write) return true;
  }
  return false;
}

/// A slot is written again two rounds later. If the message is read in its own round, the sender's last stage of the
/// round between waits for it, else the sending stage itself.
void add_slot_free(Model& model, const StepGraph& graph, const Message& message, std::vector<Link>& links) {
  const int count = static_cast<int>(graph.stages.size());
  const bool same_round = message.sent_in < message.read_in;
  const int read = message.read_in + (same_round ? 0 : count);
  if (message.from == message.to || reading_is_awaited(model, message, read, 2 * count + message.sent_in)) return;
  const int waiting = same_round ? count - 1 : message.sent_in;
  links.push_back({graph.node(graph.place_of(message.to), message.read_in),
                   graph.node(graph.place_of(message.from), waiting), true});
}

std::vector<double> counted_work(Model& model) {
  std::vector<double> cost;
  const int stages = static_cast<int>(model.stages().size());
  for (const SubModelId s : model.held())
    for (int stage = 0; stage < stages; ++stage) cost.push_back(model.sub_model(s).counted_work(stage));
  return cost;
}

/// A message from elsewhere is one predecessor more. None comes from before the opening round.
void await_message(StepGraph& graph, const Message& message) {
  const NodeId node = graph.node(graph.place_of(message.to), message.read_in);
  ++graph.predecessors[node];
  if (!message.next_round()) ++graph.opening_predecessors[node];
  graph.awaits_messages = true;
}

}  // namespace

StepGraph assemble_graph(std::vector<std::string> stages, std::size_t sub_models, std::vector<Link> links,
                         std::vector<double> cost) {
  StepGraph graph;
  graph.sub_models = sub_models;
  graph.ids.resize(sub_models);
  std::iota(graph.ids.begin(), graph.ids.end(), SubModelId{0});
  graph.stages = std::move(stages);
  graph.cost = std::move(cost);
  if (graph.cost.size() != graph.node_count()) throw std::logic_error("a graph needs one cost per node");
  if (std::none_of(graph.cost.begin(), graph.cost.end(), [](double c) { return c > 0; }))
    std::fill(graph.cost.begin(), graph.cost.end(), 1.0);
  check_forward(graph, links);
  add_own_order(graph, links);
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  graph.same_round = successors_of(graph.node_count(), links, false);
  graph.next_round = successors_of(graph.node_count(), links, true);
  count_predecessors(graph);
  return graph;
}

StepGraph build_step_graph(Model& model) {
  StepGraph shape;
  shape.ids = model.held();
  shape.sub_models = shape.ids.size();
  for (const Stage& stage : model.stages()) shape.stages.emplace_back(stage.name);
  std::vector<Link> links;
  std::vector<Message> from_elsewhere;
  for (const Message& m : plan_messages(model)) {
    if (!model.placement().holds(m.to)) continue;
    if (!model.placement().holds(m.from)) {
      from_elsewhere.push_back(m);
      continue;
    }
    links.push_back(
        {shape.node(shape.place_of(m.from), m.sent_in), shape.node(shape.place_of(m.to), m.read_in), m.next_round()});
    add_slot_free(model, shape, m, links);
  }
  StepGraph graph = assemble_graph(shape.stages, shape.sub_models, std::move(links), counted_work(model));
  graph.ids = shape.ids;
  for (const Message& m : from_elsewhere) await_message(graph, m);
  return graph;
}

}  // namespace moraine::runtime
