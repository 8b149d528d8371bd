// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

#include "physics/scene/settings.hpp"

namespace moraine {

/// "97,038".
std::string grouped(std::uint64_t number);

/// "1200 year" where the scene labels its steps, else "12.5 s".
std::string time_label(const TimeSettings& settings, std::int64_t step, double time);

/// Seconds as "12 s", "3 min 05 s" or "2 h 10 min".
std::string duration_label(double seconds);

}  // namespace moraine
