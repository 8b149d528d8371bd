// SPDX-License-Identifier: Apache-2.0
// Small scenes in which engines are tried, as texts.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "physics/world.hpp"

namespace moraine::test {

/// A scene of balls of diameter `s` and more, that `scale`, `x` and `y` size and place.
inline std::string balls(const std::string& items, const std::string& more = "", const std::string& material = "") {
  return "parameters: {s: 1, x: 0, y: 0}\ngravity: [0, 0, -9.81]\nmaterials: {rock: {density: 1000" + material +
         "}}\nelements:\n  - {packing: list, shape: {sphere: s / 2}, items: [" + items +
         "]}\ntime: {dt: 0.005 * sqrt(s), steps: 1}\n" + more;
}

inline const std::string floor = "boundaries: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}}]\n";

/// A shape that not every engine does, and the sphere that the others get in its place.
struct Other {
  Geometry geometry;
  std::string text, instead;
};

inline const std::vector<Other>& others() {
  static const std::vector<Other> all{
      {Cuboid{}, "{box: [0.9 * s, 0.7 * s, 0.8 * s]}", "{sphere: 0.4 * s}"},
      {Capsule{}, "{capsule: {radius: 0.3 * s, length: 0.5 * s}}", "{sphere: 0.2 * s}"},
      {ConvexHull{},
       "{hull: {points: [[0.4 * s, 0, 0], [-0.4 * s, 0, 0], [0, 0.4 * s, 0], [0, -0.4 * s, 0], [0, 0, 0.5 * s], "
       "[0, 0, -0.5 * s]]}}",
       "{sphere: 0.6 * s}"},
      {Compound{}, "{compound: [{sphere: 0.3 * s, at: [-0.25 * s, 0, 0]}, {sphere: 0.3 * s, at: [0.25 * s, 0, 0]}]}",
       "{sphere: 0.4 * s}"}};
  return all;
}

/// One of each above the pile.
inline std::string others_for(const Engine& engine) {
  static const char* const places[] = {
      "at: [x + 0.8 * s, y + 0.8 * s, 3.8 * s], rotation: {axis: [1, 2, 0], angle: 20}",
      "at: [x + 2.3 * s, y + 0.8 * s, 3.8 * s], rotation: {axis: [1, 0, 0], angle: 80}",
      "at: [x + 0.8 * s, y + 2.3 * s, 3.8 * s]", "at: [x + 2.3 * s, y + 2.3 * s, 3.8 * s]"};
  std::string text = "\n  - packing: list\n    shape: {sphere: 0.4 * s}\n    items:";
  for (std::size_t i = 0; i < others().size(); ++i) {
    const Other& o = others()[i];
    text += fmt::format("\n      - {{id: {}, shape: {}, {}}}", 200 + i,
                        engine.supports(o.geometry) ? o.text : o.instead, places[i]);
  }
  return text;
}

/// Spheres and everything else, bonded here and there, fall a little into a box of planes and onto a mesh.
inline std::string pile_of(const Engine& engine) {
  return R"(
parameters: {s: 1, x: 0, y: 0}
gravity: [0, 0, -9.81]
materials: {rock: {density: 1000, friction: 0.5, restitution: 0.2}}
elements:
  - {packing: cubic, shape: {sphere: s / 2}, cells: [3, 3, 3], at: [x + 0.1 * s, y + 0.1 * s, 0.05 * s], jitter: 0.02, spacing: 1.05, seed: 4, id_start: 100})" +
         others_for(engine) + R"(
boundaries:
  - {plane: {point: [x, y, 0], normal: [1, 0, 0]}}
  - {plane: {point: [x, y, 0], normal: [0, 1, 0]}}
  - {plane: {point: [x + 3.4 * s, y, 0], normal: [-1, 0, 0]}}
  - {plane: {point: [x, y + 3.4 * s, 0], normal: [0, -1, 0]}}
  - {box: [[x - s, y - s, 0], [x + 5 * s, y + 5 * s, 9 * s]], triangulated: true, open_top: true}
time: {dt: 0.005 * sqrt(s), steps: 1}
)" +
         (engine.bonds ? R"(
bonds:
  - {a: 100, b: 101, stiffness: 1e5 * s^2, damping: 100 * s^2.5, break_length: 1.2}
  - {a: 104, b: 113, stiffness: 1e5 * s^2}
)"
                       : "");
}

}  // namespace moraine::test
