// SPDX-License-Identifier: Apache-2.0
// Traces as Chrome trace JSON, which Perfetto and chrome://tracing open: process = rank, thread = worker, an arrow from
// the task that released another to that one.
#pragma once

#include <filesystem>

#include "runtime/trace/trace_file.hpp"

namespace moraine::runtime {

/// Whether a trace of that name is JSON: it ends in .json.
bool is_chrome_file(const std::filesystem::path& file);
/// What the JSON form cannot show stands in it under "moraine", so that nothing is lost; times are rounded to 1 ns.
/// Errors: std::runtime_error naming the file.
void write_chrome(const Trace& trace, const std::filesystem::path& file);
/// What write_chrome() wrote. Errors: TraceError.
Trace read_chrome(const std::filesystem::path& file);

/// A trace of either form. Errors: TraceError.
Trace read_trace(const std::filesystem::path& file);

}  // namespace moraine::runtime
