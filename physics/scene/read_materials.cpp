// SPDX-License-Identifier: Apache-2.0
// The sections `materials` and `material_pairs`.
#include <fmt/format.h>

#include <cmath>

#include "physics/scene/draft.hpp"

namespace moraine {
namespace {

std::uint32_t material_named(const Node& name, const Scene& scene) {
  const std::string wanted = name.text();
  const auto& materials = scene.materials.materials;
  std::vector<std::string_view> names;
  for (std::uint32_t i = 0; i < materials.size(); ++i) {
    if (materials[i].name == wanted) return i;
    names.push_back(materials[i].name);
  }
  name.fail(fmt::format("no material '{}', expected one of {}{}", wanted, listing(names), suggestion(wanted, names)));
}

/// A contact is a linear spring or follows from the modulus, not both.
void read_elasticity(const Node& node, Material& material) {
  const auto young = node.find("young");
  if (!young && node.find("poisson"))
    node.at("poisson").fail("'poisson' is stated without 'young', expected both or none");
  if (young && node.find("normal_stiffness"))
    young->fail("a material states both 'young' and 'normal_stiffness', expected one of them");
  if (young) material.young = young->positive();
  if (const auto poisson = node.find("poisson")) material.poisson = poisson->within(0, 0.5);
  if (const auto stiffness = node.find("normal_stiffness")) material.normal_stiffness = stiffness->positive();
}

Material read_one(const std::string& name, const Node& node) {
  node.allow({"density", "friction", "restitution", "rolling_friction", "normal_stiffness", "young", "poisson"});
  Material material;
  material.name = name;
  material.density = node.at("density", "the density [kg/m^3]").positive();
  material.friction = node.not_negative("friction", 0);
  if (const auto restitution = node.find("restitution")) material.restitution = restitution->within(0, 1);
  material.rolling_friction = node.not_negative("rolling_friction", 0);
  read_elasticity(node, material);
  return material;
}

void set_default_pairs(MaterialTable& table) {
  for (const Material& a : table.materials) {
    for (const Material& b : table.materials) {
      table.pairs.push_back({std::sqrt(a.friction * b.friction), std::sqrt(a.restitution * b.restitution),
                             std::sqrt(a.rolling_friction * b.rolling_friction)});
    }
  }
}

void read_pair(const Node& node, Scene& scene) {
  node.allow({"between", "friction", "restitution", "rolling_friction"});
  const std::vector<Node> names = node.at("between", "two materials").items("two materials [a, b]", 2);
  const std::uint32_t a = material_named(names[0], scene), b = material_named(names[1], scene);
  const std::size_t count = scene.materials.materials.size();
  PairLaw law = scene.materials.pair(a, b);
  law.friction = node.not_negative("friction", law.friction);
  if (const auto restitution = node.find("restitution")) law.restitution = restitution->within(0, 1);
  law.rolling_friction = node.not_negative("rolling_friction", law.rolling_friction);
  scene.materials.pairs[a * count + b] = law;
  scene.materials.pairs[b * count + a] = law;
}

}  // namespace

std::uint32_t read_material(const Node& entry, const Scene& scene) {
  if (const auto name = entry.find("material")) return material_named(*name, scene);
  const std::size_t count = scene.materials.materials.size();
  if (count == 1) return 0;
  entry.fail(fmt::format("no 'material' here, expected the name of one of the scene's {} materials", count));
}

void read_materials(const Node& root, Draft& draft) {
  if (const auto materials = root.find("materials")) {
    for (const auto& [name, node] : materials->entries()) {
      draft.scene.materials.materials.push_back(read_one(name, node));
    }
  }
  set_default_pairs(draft.scene.materials);
  if (const auto pairs = root.find("material_pairs")) {
    for (const Node& pair : pairs->items("a list of pairs")) read_pair(pair, draft.scene);
  }
}

}  // namespace moraine
