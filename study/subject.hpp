// SPDX-License-Identifier: Apache-2.0
// The scene under study, and the ways to run it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "physics/scene/reader.hpp"
#include "study/axis.hpp"

namespace moraine::study {

/// A way to run the scene, worked out.
struct Setting {
  Choices choices;                ///< what it was made from
  std::vector<Override> changes;  ///< of the scene; a later one of the same key counts
  std::string engine, precision, coupling, split;
  int sub_models = 0;  ///< 0: auto
  double dt = 0;       ///< [s]; divides the scene's duration
  std::int64_t steps = 0;
  int substeps = 1, iterations = 1;
  std::string identity;  ///< of what is computed: scene, settings, duration

  /// "impulse, 0.01667 s / 4, 1 iteration", and what else was chosen.
  std::string label() const;
};

/// 16 hex digits over all of a scene that changes results, but for its duration.
using Identify = std::function<std::string(const Scene&)>;

class Subject {
 public:
  /// Reads the scene. Errors: InputError.
  Subject(std::string file, std::vector<Override> overrides, Identify identify);

  const Scene& scene() const { return scene_; }
  const std::string& file() const { return file_; }
  double duration() const { return duration_; }

  /// The scene with these choices. A step that does not divide the duration is changed a little, so that all settings
  /// end at the same time. Errors: InputError, at the place of the choice.
  Setting resolve(const Choices& choices) const;
  /// All of them, those that come to the same dropped.
  std::vector<Setting> resolve(const std::vector<Choices>& all) const;

  /// The grid: the scene's, else the usual settings of every engine that takes its shapes.
  std::vector<AxisBlock> grid() const;
  /// The scene's reference, else soft_sphere at half its largest substep.
  /// Errors: InputError if the scene states none and soft_sphere does not take its shapes.
  Choices reference() const;
  /// The scene made small as it says; itself if it does not say how.
  Subject proxy() const;
  bool has_proxy() const { return !scene_.study.proxy.empty(); }

  /// Those of this subject and the setting's.
  std::vector<Override> settings(const Setting& setting) const;
  /// All overrides of a run with a setting: those of this subject, the setting's, those that vary the seed.
  std::vector<Override> overrides(const Setting& setting, int seed) const;
  /// How seeds differ, in words.
  std::string seeds_text() const;

 private:
  double perturbation_speed() const;

  std::string file_;
  std::vector<Override> overrides_;
  Identify identify_;
  Scene scene_;
  double duration_;
};

/// The command that runs a scene so, to be pasted into a shell.
std::string command_line(const std::string& file, const std::vector<Override>& overrides);
/// The same settings as sections of a scene file.
std::string yaml_text(const std::vector<Override>& changes);

}  // namespace moraine::study
