// SPDX-License-Identifier: Apache-2.0
// What results are compared with: the reference's, or values known to be right.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/error.hpp"
#include "study/observable.hpp"
#include "study/record.hpp"

namespace moraine::study {

class Yardstick {
 public:
  struct Mark {
    const Observable* observable = nullptr;
    double scale = 1;      ///< a deviation of so much is an error of 100 %
    Sample reference;      ///< count 0: known exactly
    bool counted = false;  ///< towards the error of a setting
  };

  /// Whether some counted observable has no expected value, so that reference runs are needed.
  /// Errors: InputError if the scene names an observable that does not exist.
  static bool needs_reference(const Scene& scene);
  /// `runs`: of the reference. Errors: InputError if a counted observable is neither expected nor in the runs.
  Yardstick(const Scene& scene, std::span<const Record> runs);

  const std::vector<Mark>& marks() const { return marks_; }
  /// Of all observables that the runs have.
  std::vector<Comparison> compare(std::span<const Record> runs) const;
  /// Of those that count.
  std::vector<Comparison> compare_counted(std::span<const Record> runs) const;
  /// Of the reference itself: what its seeds alone amount to. Nothing if all is expected or there is one seed only.
  std::optional<double> noise() const;

 private:
  std::vector<Mark> marks_;
};

/// The values of one observable in the runs that have it.
Sample sample_of(const Observable& observable, std::span<const Record> runs);

}  // namespace moraine::study
