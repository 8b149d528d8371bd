// SPDX-License-Identifier: Apache-2.0
// Which tasks wait for which.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "runtime/message_plan.hpp"
#include "runtime/schedule/registry.hpp"
#include "runtime/schedule/simulated_machine.hpp"
#include "runtime/step_graph.hpp"
#include "tests/support/gossip_model.hpp"

namespace moraine::runtime {
namespace {

using test::GossipModel;
using test::RandomGossip;

std::vector<NodeId> list(std::span<const NodeId> nodes) { return {nodes.begin(), nodes.end()}; }

using Nodes = std::vector<NodeId>;

TEST(StepGraph, LonelySubModelRunsItsStagesInOrder) {
  GossipModel model(2, {{"a"}, {"b"}, {"c"}});
  const StepGraph graph = build_step_graph(model);
  EXPECT_EQ(graph.stages, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(graph.node(1, 2), 5U);
  EXPECT_EQ(graph.sub_model(5), 1U);
  EXPECT_EQ(graph.stage(5), 2);
  EXPECT_EQ(list(graph.same_round.of(3)), Nodes{4});
  EXPECT_EQ(list(graph.same_round.of(5)), Nodes{});
  EXPECT_EQ(list(graph.next_round.of(5)), Nodes{3});
  EXPECT_EQ(graph.predecessors, (std::vector<std::uint32_t>{1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(graph.opening_predecessors, (std::vector<std::uint32_t>{0, 1, 1, 0, 1, 1}));
}

TEST(StepGraph, NeighboursWaitForEachOtherOnly) {
  GossipModel model(3, {{"tell"}, {"move", 0}});
  model.link(0, 1, 1);
  model.link(1, 0, 1);
  const StepGraph graph = build_step_graph(model);
  EXPECT_EQ(list(graph.same_round.of(0)), (Nodes{1, 3}));
  EXPECT_EQ(list(graph.same_round.of(2)), (Nodes{1, 3}));
  EXPECT_EQ(list(graph.same_round.of(4)), (Nodes{5}));
  // Both ways: the exchange itself keeps them within a round.
  EXPECT_EQ(list(graph.next_round.of(1)), (Nodes{0}));
  EXPECT_EQ(list(graph.next_round.of(3)), (Nodes{2}));
}

TEST(StepGraph, OneWayMessageHoldsTheSenderBack) {
  GossipModel model(2, {{"tell"}, {"move", 0}});
  model.link(0, 1, 1);
  const StepGraph graph = build_step_graph(model);
  EXPECT_EQ(list(graph.same_round.of(0)), (Nodes{1, 3}));
  EXPECT_EQ(list(graph.next_round.of(3)), (Nodes{1, 2})) << "reading, to the sender's last stage of the next round";
}

TEST(StepGraph, OneWayMessageOfTheRoundBeforeHoldsTheSenderBack) {
  GossipModel model(2, {{"move", 1}, {"tell"}});
  model.link(0, 1, 0);
  const StepGraph graph = build_step_graph(model);
  EXPECT_EQ(list(graph.next_round.of(1)), (Nodes{0, 2}));
  EXPECT_EQ(list(graph.next_round.of(2)), (Nodes{1})) << "reading, to the next telling";
  EXPECT_EQ(graph.opening_predecessors, (std::vector<std::uint32_t>{0, 1, 0, 1}));
}

TEST(StepGraph, CostIsCountedWork) {
  GossipModel model(2, {{"a"}, {"b"}});
  for (SubModelId id = 0; id < 2; ++id) model.sub_model(id).cost = [id](int stage) { return 10.0 * id + stage; };
  EXPECT_EQ(build_step_graph(model).cost, (std::vector<double>{0, 1, 10, 11}));
  for (SubModelId id = 0; id < 2; ++id) model.sub_model(id).cost = [](int) { return 0.0; };
  EXPECT_EQ(build_step_graph(model).cost, (std::vector<double>{1, 1, 1, 1}));
}

TEST(StepGraph, EmptyModelGivesAnEmptyGraph) {
  GossipModel model(0, {{"a"}, {"b", 0}});
  EXPECT_EQ(build_step_graph(model).node_count(), 0U);
}

TEST(StepGraph, RefusesLinksBackWithinARound) {
  EXPECT_THROW(assemble_graph({"a", "b"}, 2, {{1, 2, false}}, std::vector<double>(4)), std::logic_error);
  EXPECT_THROW(assemble_graph({"a", "b"}, 2, {{1, 4, true}}, std::vector<double>(4)), std::logic_error);
  EXPECT_THROW(assemble_graph({"a", "b"}, 2, {}, std::vector<double>(3)), std::logic_error);
}

void expect_refusal(Model& model, const std::string& part) {
  try {
    build_step_graph(model);
    FAIL() << "expected: " << part;
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(StepGraph, NamesThePairThatDoesNotMirror) {
  GossipModel model(3, {{"tell"}, {"move", 0}});
  model.sub_model(2).sources_of[1] = {1};
  expect_refusal(model, "1 is a source of 2, but 2 is not a target of 1");
  model.sub_model(2).sources_of[1] = {};
  model.sub_model(0).targets_of[0] = {2};
  expect_refusal(model, "2 is a target of 0, but 0 is not a source of 2");
}

TEST(StepGraph, RefusesListsThatMakeNoSense) {
  GossipModel model(3, {{"tell"}, {"move", 0}});
  model.sub_model(0).targets_of[0] = {2, 1};
  expect_refusal(model, "not ascending");
  model.sub_model(0).targets_of[0] = {7};
  expect_refusal(model, "sub-model 7 of 3");
  model.sub_model(0).targets_of[0] = {};
  model.sub_model(0).sources_of[0] = {1};
  expect_refusal(model, "receives nothing");
  GossipModel twice(1, {{"tell"}, {"move", 0}, {"look", 0}});
  expect_refusal(twice, "move and look both receive from tell");
  GossipModel beyond(1, {{"tell", 3}});
  expect_refusal(beyond, "does not exist");
}

/// Starts and ends of every task of a simulated run.
using Times = std::map<std::pair<NodeId, std::int64_t>, SimulatedTask>;

/// Whatever the tasks take, a message is read before its slot is written again, and written before it is read.
void expect_slots_hold(const std::vector<Message>& plan, const StepGraph& graph, const Times& times) {
  for (const Message& m : plan) {
    const std::int64_t later = m.sent_in < m.read_in ? 0 : 1;
    for (const auto& [key, written] : times) {
      if (key.first != graph.node(m.from, m.sent_in)) continue;
      const auto read = times.find({graph.node(m.to, m.read_in), key.second + later});
      const auto again = times.find({key.first, key.second + 2});
      if (read == times.end()) continue;
      EXPECT_LE(written.end, read->second.start);
      if (again == times.end()) continue;
      EXPECT_LE(read->second.end, again->second.start);
    }
  }
}

TEST(StepGraph, NoSlotIsOverrunHoweverLongTasksTake) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    RandomGossip model(seed, 2 + seed % 6);
    model.begin_epoch(0, 1);
    const StepGraph graph = build_step_graph(model);
    std::vector<double> slow;  // some nodes are a thousand times slower
    for (std::size_t n = 0; n < graph.node_count(); ++n) slow.push_back(random() % 4 == 0 ? 1000.0 : 1.0);
    Times times;
    const auto scheduler = find_scheduler("critical_path").make();
    for (const SimulatedTask& t : simulate(*scheduler, graph, 64, 12, [&](Task task) {
                                    return slow[task.node] * double(1 + random() % 9);
                                  }).tasks)
      times[{t.task.node, t.task.round}] = t;
    EXPECT_EQ(times.size(), graph.node_count() * 12);
    expect_slots_hold(plan_messages(model), graph, times);
  }
}

}  // namespace
}  // namespace moraine::runtime
