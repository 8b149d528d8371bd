// SPDX-License-Identifier: Apache-2.0
// A sub-model to bytes and back.
#include "ghosting/sub_model.hpp"
#include "physics/errors.hpp"

namespace moraine {

void SubModel::save(std::vector<std::byte>& out) const { world_->save(out); }
void SubModel::load(std::span<const std::byte> in) { world_->load(in); }

}  // namespace moraine
