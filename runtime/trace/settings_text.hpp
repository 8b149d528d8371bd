// SPDX-License-Identifier: Apache-2.0
// A trace's settings as JSON text.
#pragma once

#include <string>
#include <string_view>

#include "runtime/trace/trace.hpp"

namespace moraine::runtime {

std::string settings_text(const TraceSettings& settings);
/// Errors: TraceError if the text is no JSON, or misses a setting.
TraceSettings read_settings(std::string_view text);

}  // namespace moraine::runtime
