// SPDX-License-Identifier: Apache-2.0
// Runs a scene that may be too much for an engine, and says how it ended. Every run leaves a row for docs/extremes.md.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "runtime/run_error.hpp"
#include "tests/support/drops.hpp"
#include "tests/support/model_run.hpp"

namespace moraine::test {

inline const std::string all_engines[] = {"bullet", "impulse", "soft_sphere"};

/// How a run ended. Whatever happens, no number is lost: what ran has finite states only.
struct Outcome {
  enum class End { ran, refused, stopped };
  End end = End::ran;
  std::string text;  ///< of what refused or stopped it
  std::vector<std::string> warnings;
  ModelStatistics statistics;
  OverlapStatistics overlaps;
  std::vector<ElementState> states;  ///< at the end, in the order of ids
  double mass = 0, diameter = 1;     ///< all of it; typical

  bool ran() const { return end == End::ran; }
  bool warned(const std::string& part) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](auto& w) { return w.find(part) != std::string::npos; });
  }
  bool says(const std::string& part) const { return text.find(part) != std::string::npos; }
  const Vec3& position(std::size_t i) const { return states.at(i).pose.position; }
  const Vec3& velocity(std::size_t i) const { return states.at(i).twist.linear; }
  /// Largest speed of all [m/s].
  double speed() const {
    double most = 0;
    for (const ElementState& s : states) most = std::max(most, s.twist.linear.norm());
    return most;
  }
  bool finite() const {
    return std::all_of(states.begin(), states.end(), [](const ElementState& s) {
      return s.pose.position.allFinite() && s.twist.linear.allFinite() && s.twist.angular.allFinite();
    });
  }
  /// One word.
  std::string ending() const {
    if (end == End::refused) return "refused";
    if (end == End::stopped) return "stopped";
    return warnings.empty() ? "ran" : "ran, warned";
  }
};

/// Reads and runs all steps; looks at it at the end.
inline Outcome attempt(const std::string& text, const std::vector<Override>& overrides) {
  Outcome o;
  try {
    const Scene scene = scene_of(text, overrides);
    o.diameter = scene.typical_diameter();
    ModelRun run(scene);
    run.go().conclude();
    o.warnings = scene.warnings;
    for (std::string& w : run.model().warnings()) o.warnings.push_back(std::move(w));
    o.statistics = run.model().statistics(scene.time.steps * scene.time.substeps);
    o.overlaps = run.model().overlaps();
    o.states = run.model().states();
    for (const Element& e : scene.elements) o.mass += e.mass;
  } catch (const InputError& e) {
    o.end = Outcome::End::refused;
    o.text = e.what();
  } catch (const InvalidStateError& e) {
    o.end = Outcome::End::stopped;
    o.text = e.what();
  } catch (const runtime::RunError& e) {
    o.end = Outcome::End::stopped;
    o.text = e.what();
  }
  EXPECT_TRUE(o.finite()) << "a number was lost without a word";
  return o;
}

/// Names tests by their engine.
struct ByEngine {
  template <class Param>
  std::string operator()(const testing::TestParamInfo<Param>& test) const {
    return fmt::format("{}_{}", std::get<0>(test.param), test.index);
  }
};

/// What cannot run is refused or stopped with these words.
inline void expect_end(const Outcome& o, bool runs, const std::string& words) {
  EXPECT_EQ(o.ran(), runs) << o.text;
  EXPECT_TRUE(o.ran() || o.says(words)) << o.text;
}

/// Overrides that run a scene for `seconds` with the engine's own step: half its limit, else `step` [s].
inline std::vector<Override> for_time(const std::string& text, const std::string& engine, double seconds, double step,
                                      std::vector<Override> overrides = {}) {
  overrides.push_back(set("run.engine", engine));
  const StepLimit limit = find_engine(engine).step_limit(scene_of(text, overrides));
  const double dt = std::min(step, 0.5 * limit.substep);
  overrides.push_back(set("time.dt", dt));
  overrides.push_back(set("time.steps", std::ceil(seconds / dt)));
  return overrides;
}

/// A row of the table in docs/extremes.md, appended to the file that MORAINE_EXTREMES names.
inline void record(const std::string& name, const std::string& engine, const std::string& setting,
                   const std::string& ending, const std::string& figure) {
  const char* file = std::getenv("MORAINE_EXTREMES");
  if (file)
    std::ofstream(file, std::ios::app) << fmt::format("{}|{}|{}|{}|{}\n", name, setting, engine, ending, figure);
}

/// The rule for all: energy came from nowhere neither silently nor, where nobody warned, at all.
inline void expect_no_silent_gain(const Outcome& o) {
  if (!o.ran() || o.warned("energy: ")) return;
  const ModelStatistics& s = o.statistics;
  const double lift = 0.05 * o.mass * 9.81 * o.diameter;
  EXPECT_LE(s.energy.gained, lift + 0.25 * std::max(s.energy.kinetic, 1e-12) + 0.02 * std::abs(s.energy.dissipated));
  EXPECT_LT(s.linear_residual, 1e-3);
}

}  // namespace moraine::test
