// SPDX-License-Identifier: Apache-2.0
// Ranks agree on what went wrong.
#pragma once

#include <optional>

#include "runtime/run_error.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// Called by all ranks at the end of an epoch, with their failure if they have one: the first of all by (round,
/// sub-model, rank), the same on every rank.
std::optional<RunError> first_failure(Transport& transport, const std::optional<RunError>& own);

}  // namespace moraine::runtime
