// SPDX-License-Identifier: Apache-2.0
// Brings together what ranks know of the sub-models they hold.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "physics/types.hpp"
#include "runtime/sub_model.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine {

/// Bytes of every sub-model, by number, as its owner gives them: on all ranks, or on `root` alone (nothing elsewhere).
/// Collective. Cost: one exchange.
std::vector<runtime::Bytes> collect(const runtime::Model& model, runtime::Transport& transport,
                                    const std::function<runtime::Bytes(SubModelId)>& give,
                                    std::optional<int> root = std::nullopt);

}  // namespace moraine
