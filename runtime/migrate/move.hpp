// SPDX-License-Identifier: Apache-2.0
// Sub-models change ranks.
#pragma once

#include <cstdint>

#include "runtime/sub_model.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

struct Moved {
  std::int64_t sub_models = 0;  ///< of all ranks
  std::uint64_t bytes = 0;      ///< sent by this rank
};

/// Saves what leaves this rank, sends it, and adopts what comes. Called by all ranks with the same owners, between the
/// settling of neighbours and the first round of an epoch.
Moved move(Model& model, Transport& transport, const std::vector<int>& owners);

/// A saved sub-model among others in a list of bytes.
void append_sub_model(SubModel& sub_model, SubModelId id, Bytes& out);
/// Adopts all that append_sub_model() wrote. Errors: std::runtime_error if the list is truncated.
void adopt_all(Model& model, std::span<const std::byte> in);

}  // namespace moraine::runtime
