// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/reader.hpp"

#include <array>

#include "physics/errors.hpp"
#include "physics/scene/draft.hpp"

namespace moraine {
namespace {

constexpr std::array<std::string_view, 14> top_keys = {
    "name",  "parameters",   "gravity", "materials", "material_pairs", "elements", "boundaries",
    "bonds", "perturbation", "time",    "run",       "output",         "tradeoff", "expect"};

Scene read(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  const Document document(file, overrides, top_keys);
  const Node root = Node::root(document);
  root.allow(top_keys);

  Draft draft(file.parent_path());
  Scene& scene = draft.scene;
  scene.name = root.text("name", file.stem().string());
  scene.source = file.string();
  scene.gravity = root.vector("gravity", scene.gravity);
  read_time(root, scene.time);
  read_run(root, scene.run);
  read_output(root, scene.output);
  read_study(root, document.expressions().names(), scene.study);
  read_materials(root, draft);
  read_elements(root, draft);
  read_perturbation(root, scene);
  read_boundaries(root, draft);
  read_bonds(root, draft);
  return std::move(scene);
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  try {
    return read(file, overrides);
  } catch (const YAML::Exception& e) {
    throw InputError(file.string() + ": " + e.what() + ", expected a scene");
  }
}

}  // namespace moraine
