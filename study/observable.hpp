// SPDX-License-Identifier: Apache-2.0
// Quantities of a run's result that settings are compared by.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "physics/scene/scene.hpp"

namespace moraine::study {

struct Observable {
  std::string_view name;
  std::string_view help;
  std::string_view unit;
  std::string_view pointer;  ///< into summary.json (RFC 6901)
  /// A deviation of so much is an error of 100 %, unless the scene states another.
  double (*scale)(const Scene& scene, double reference);
};

/// The table of observables.
std::span<const Observable> observables();
/// Errors: InputError at `place` that prints the table.
const Observable& find_observable(std::string_view name, const std::string& place);

/// Nothing if the summary has no such number.
std::optional<double> value_of(const Observable& observable, const nlohmann::json& summary);

}  // namespace moraine::study
