// SPDX-License-Identifier: Apache-2.0
// What a scene says about measuring its own accuracy: the sections `tradeoff` and `expect`.
#pragma once

#include <string>
#include <vector>

namespace moraine {

/// A setting and the values to try, as they are written. The key is short (`dt`) or what `--set` takes.
struct Axis {
  std::string key;
  std::vector<std::string> values;
  std::string place;  ///< for error texts
};

/// Axes tried in all combinations.
using AxisBlock = std::vector<Axis>;

/// A quantity of the result that counts towards the error.
struct CountedObservable {
  std::string name;
  double scale = 0;  ///< a deviation of so much is an error of 100 %; 0: the observable's own
  std::string place;
};

/// A quantity whose right value is known.
struct Expectation {
  std::string observable;
  double value = 0;
  double scale = 0;  ///< as above
  std::string place;
};

struct StudySettings {
  AxisBlock reference;          ///< one value each; empty: engine soft_sphere at half its largest substep
  std::vector<AxisBlock> grid;  ///< empty: all engines that take the scene, with usual settings
  int seeds = 3;
  std::string seed;  ///< the parameter that differs between seeds; empty: starts are perturbed
  std::vector<CountedObservable> observables;
  AxisBlock proxy;  ///< one value each: what makes the scene small; empty: it has no small version
  std::vector<Expectation> expect;
};

}  // namespace moraine
