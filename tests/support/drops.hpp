// SPDX-License-Identifier: Apache-2.0
// Small scenes with known answers, as texts.
#pragma once

#include <fmt/format.h>

#include <string>

namespace moraine::test {

/// Spheres of radius 0.1 m; items without mass have 1 kg. `more`: further sections.
inline std::string spheres(const std::string& items, const std::string& material, const std::string& more) {
  return "parameters: {dt: 1e-3}\nmaterials: {ball: {density: 1000, " + material +
         "}}\nelements:\n  - {packing: list, shape: {sphere: 0.1}, mass: 1, items: [" + items + "]}\n" +
         "time: {dt: dt, steps: 1}\n" + more;
}

inline const std::string floor_at_zero = "boundaries: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}}]\n";
inline const std::string weightless = "gravity: [0, 0, 0]\n";
inline const std::string in_two = "run: {sub_models: 2, split: slabs}\n";

/// Engines that solve contacts by impulses: right whatever the step.
inline const std::string impulse_engines[] = {"bullet", "impulse"};

}  // namespace moraine::test
