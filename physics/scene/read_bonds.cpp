// SPDX-License-Identifier: Apache-2.0
// The `bonds` section: between all touching spheres, or a list.
#include <fmt/format.h>

#include <algorithm>

#include "physics/scene/bonds.hpp"
#include "physics/scene/draft.hpp"

namespace moraine {
namespace {

struct BondLaw {
  double stiffness = 0;
  double damping = 0;
  BreakLength break_length;
};

BreakLength read_break_length(const Node& node) {
  if (!node.is_map()) return {node.positive(), 0, 1};
  node.allow({"mean", "spread", "seed"});
  return {node.at("mean", "rest lengths").positive(), node.not_negative("spread", 0),
          static_cast<std::uint64_t>(node.integer("seed", 1, 0))};
}

BondLaw read_law(const Node& node) {
  BondLaw law;
  law.stiffness = node.at("stiffness", "the stiffness [N/m]").positive();
  law.damping = node.not_negative("damping", 0);
  if (const auto length = node.find("break_length")) {
    law.break_length = read_break_length(*length);
    if (law.break_length.mean <= 1)
      length->fail("a bond that breaks at rest, expected a break length of more than 1 (rest lengths)");
  }
  return law;
}

/// Two elements, a before b.
Bond make_bond(const Node& node, const Element& a, const Element& b, const BondLaw& law) {
  const double length = (a.state.pose.position - b.state.pose.position).norm();
  if (!(length > 0))
    node.fail(
        fmt::format("elements {} and {} are at the same place, expected a rest length of more than 0", a.id, b.id));
  return {a.id, b.id, length, law.stiffness, law.damping, length * law.break_length.of(a.id, b.id)};
}

void read_touching(const Node& node, Scene& scene) {
  node.allow({"between", "tolerance", "stiffness", "damping", "break_length"});
  const Node between = node.at("between", "touching");
  if (between.text() != "touching") between.fail(fmt::format("'between' is '{}', expected touching", between.raw()));
  const BondLaw law = read_law(node);
  for (const auto& [a, b] : touching_pairs(scene, node.not_negative("tolerance", 1e-3))) {
    scene.bonds.push_back(make_bond(node, *find_element(scene.elements, a), *find_element(scene.elements, b), law));
  }
  const bool others = std::any_of(scene.elements.begin(), scene.elements.end(),
                                  [&](const Element& e) { return !scene.shape_of(e).sphere(); });
  if (others) scene.warnings.emplace_back("bonds between touching elements are made for spheres only");
  if (scene.bonds.empty()) scene.warnings.emplace_back("no elements touch: there are no bonds");
}

const Element& read_end(const Node& bond, const std::string& key, const Scene& scene) {
  const Node node = bond.at(key, "the id of an element");
  const auto id = static_cast<ElementId>(node.integer(0, UINT32_MAX - 1));
  const Element* element = find_element(scene.elements, id);
  if (!element) node.fail(fmt::format("a bond to element {}, which does not exist; expected the id of an element", id));
  return *element;
}

void read_listed(const Node& list, Scene& scene) {
  std::vector<std::pair<Bond, std::string>> bonds;
  for (const Node& node : list.items("a list of bonds")) {
    node.allow({"a", "b", "stiffness", "damping", "break_length"});
    const Element* a = &read_end(node, "a", scene);
    const Element* b = &read_end(node, "b", scene);
    if (a == b) node.fail(fmt::format("a bond of element {} with itself, expected two elements", a->id));
    if (b->id < a->id) std::swap(a, b);
    bonds.emplace_back(make_bond(node, *a, *b, read_law(node)), node.place());
  }
  const auto ends = [](const auto& bond) { return std::pair(bond.first.a, bond.first.b); };
  std::stable_sort(bonds.begin(), bonds.end(), [&](const auto& x, const auto& y) { return ends(x) < ends(y); });
  for (std::size_t i = 0; i < bonds.size(); ++i) {
    if (i > 0 && ends(bonds[i]) == ends(bonds[i - 1])) {
      list.fail(fmt::format("elements {} and {} are bonded twice ({} and {}), expected once", bonds[i].first.a,
                            bonds[i].first.b, bonds[i - 1].second, bonds[i].second));
    }
    scene.bonds.push_back(bonds[i].first);
  }
}

}  // namespace

void read_bonds(const Node& root, Draft& draft) {
  const auto bonds = root.find("bonds");
  if (!bonds) return;
  if (bonds->is_list()) {
    read_listed(*bonds, draft.scene);
  } else {
    read_touching(*bonds, draft.scene);
  }
}

}  // namespace moraine
