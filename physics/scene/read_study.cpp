// SPDX-License-Identifier: Apache-2.0
// The sections `tradeoff` and `expect`.
#include <algorithm>

#include "physics/scene/draft.hpp"

namespace moraine {
namespace {

std::vector<std::string> read_values(const Node& node) {
  if (!node.is_list()) return {node.text()};
  std::vector<std::string> values;
  for (const Node& item : node.items("a list of values")) values.push_back(item.text());
  if (values.empty()) node.fail("an empty list, expected values to try");
  return values;
}

AxisBlock read_block(const Node& node) {
  AxisBlock block;
  for (const auto& [key, value] : node.entries()) block.push_back({key, read_values(value), value.place()});
  return block;
}

/// A block in which every key has one value.
AxisBlock read_choice(const Node& node) {
  AxisBlock block = read_block(node);
  for (const Axis& axis : block)
    if (axis.values.size() > 1) node.at(axis.key).fail("'" + axis.key + "' has several values, expected one");
  return block;
}

CountedObservable read_observable(const Node& node) {
  if (node.is_scalar()) return {node.text(), 0, node.place()};
  node.allow({"name", "scale"});
  return {node.at("name", "the name of an observable").text(), node.positive("scale", 0), node.place()};
}

Expectation read_expectation(const std::string& name, const Node& node) {
  if (!node.is_map()) return {name, node.number(), 0, node.place()};
  node.allow({"value", "scale"});
  return {name, node.at("value", "the right value").number(), node.positive("scale", 0), node.place()};
}

void read_tradeoff(const Node& node, StudySettings& study) {
  node.allow({"reference", "grid", "seeds", "seed", "observables", "proxy"});
  if (const auto reference = node.find("reference")) study.reference = read_choice(*reference);
  if (const auto proxy = node.find("proxy")) study.proxy = read_choice(*proxy);
  if (const auto grid = node.find("grid"))
    for (const Node& block : grid->items("a list of blocks, each a map of settings and values to try"))
      study.grid.push_back(read_block(block));
  if (const auto observables = node.find("observables"))
    for (const Node& item : observables->items("a list of observables"))
      study.observables.push_back(read_observable(item));
  study.seeds = static_cast<int>(node.integer("seeds", study.seeds, 1, 1000));
}

/// The parameter that the scene names, else `seed` if there is one, else none.
std::string read_seed(const std::optional<Node>& tradeoff, std::span<const std::string> parameters) {
  const auto named = tradeoff ? tradeoff->find("seed") : std::nullopt;
  const std::string name = named ? named->text() : "seed";
  if (std::find(parameters.begin(), parameters.end(), name) != parameters.end()) return name;
  if (named) named->fail("'" + name + "' is no parameter of the scene, expected one that seeds its random numbers");
  return "";
}

}  // namespace

void read_study(const Node& root, std::span<const std::string> parameters, StudySettings& study) {
  const auto tradeoff = root.find("tradeoff");
  if (tradeoff) read_tradeoff(*tradeoff, study);
  study.seed = read_seed(tradeoff, parameters);
  if (const auto expect = root.find("expect"))
    for (const auto& [name, value] : expect->entries()) study.expect.push_back(read_expectation(name, value));
}

}  // namespace moraine
