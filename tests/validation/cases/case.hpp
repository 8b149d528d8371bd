// SPDX-License-Identifier: Apache-2.0
// Cases with a known answer, for every engine that can run them, whole and cut. What each measures goes into the table
// of docs/accuracy.md.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine::test {

/// How a case is run.
struct Setting {
  std::string engine;
  bool cut = false;  ///< every body a sub-model of its own, at most three, unless the case says otherwise

  /// Forces of springs need steps of their own.
  bool springs() const { return engine == "soft_sphere"; }
};

/// What a case asks of an engine, added up.
enum Needs : unsigned {
  spheres_only = 0,
  needs_boxes = 1,  ///< shapes other than spheres
  needs_bonds = 2,
  needs_impulses = 4,  ///< rigid contacts: what sticks has no slip left
  needs_springs = 8,   ///< rolling friction, and contacts that give way along the surface
};

struct Case {
  const char* name;
  const char* answer;  ///< what is compared with what, and where that is from
  double (*error)(const Setting&);
  double tolerance;          ///< of engines that solve for impulses
  double tolerance_springs;  ///< of engines with springs
  unsigned needs = spheres_only;

  bool runs_with(const Engine& engine) const;
};

/// Cases that all ask the same of an engine.
std::vector<Case> needing(Needs needs, std::vector<Case> cases);

std::vector<Case> one_body();
std::vector<Case> two_bodies();
std::vector<Case> chung_ooi();
std::vector<Case> bonded();
std::vector<Case> lattices();
std::vector<Case> many_bodies();
std::vector<Case> consistency();
std::vector<Case> orders();

/// Reads a scene for a setting: its engine, its cut into as many as `run.sub_models` says or else three at most, and
/// steps of `dt` [s] or of a part of the engine's limit if that is shorter.
ModelRun trial(const Setting& setting, const std::string& text, double dt, std::vector<Override> overrides = {},
               double part_of_limit = 0.1);

/// Masses of 1 kg, spheres of 0.1 m, on bonds; no gravity. Items and bonds as a scene lists them.
std::string masses_on_springs(const std::string& items, const std::string& bonds);

/// A material for spheres(), with a stiffness for engines that have one: half a swing of two takes 2 ms.
std::string ball(const Setting& setting, const std::string& material);

/// Steps until `seconds` of the run have passed.
void run_until(ModelRun& run, double seconds);

/// The largest, or NaN if one of them is: std::max may lose it, and a case without an answer would be met.
double worst_of(std::initializer_list<double> errors);

}  // namespace moraine::test
