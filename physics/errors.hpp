// SPDX-License-Identifier: Apache-2.0
// The three ways a run can end early. Each carries the exit status the command returns.
#pragma once

#include <stdexcept>
#include <string>

namespace moraine {

/// Wrong usage or wrong input: the text reads `file:line:column: what is wrong, what was expected`. Exit status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
  static constexpr int exit_status = 2;
};

/// The simulation is no longer meaningful (NaN, runaway energy): the text names element and step. Exit status 3.
struct InvalidStateError : std::runtime_error {
  using std::runtime_error::runtime_error;
  static constexpr int exit_status = 3;
};

/// Files or the runtime failed. Exit status 4.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
  static constexpr int exit_status = 4;
};

}  // namespace moraine
