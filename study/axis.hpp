// SPDX-License-Identifier: Apache-2.0
// Settings that a study varies: their names, and grids of them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/scene/study_settings.hpp"

namespace moraine::study {

/// A short name of a setting in `tradeoff`, what --set calls it, and its option of `moraine run`.
struct ShortName {
  std::string_view name, key, flag;
};
std::span<const ShortName> short_names();

/// Substeps follow from it: a substep as a share of the largest that the engine takes.
constexpr std::string_view limit_share = "limit_share";

/// "dt" -> "time.dt"; others are as --set takes them.
std::string key_of(std::string_view name);
/// The option of `moraine run` that sets a key, if there is one.
std::optional<std::string_view> flag_of(std::string_view key);

/// One value of each axis of a block.
struct Choice {
  std::string name, value, place;
};
using Choices = std::vector<Choice>;

/// All combinations of every block, the last axis changing fastest.
std::vector<Choices> combinations(std::span<const AxisBlock> blocks);

/// Narrows blocks to the values of `axis`: in every block that has it, these replace its own. Blocks for other engines
/// are dropped; an engine that no block is for, and another axis that a block lacks, is added.
void narrow(std::vector<AxisBlock>& blocks, const Axis& axis);

}  // namespace moraine::study
