// SPDX-License-Identifier: Apache-2.0
// Which element belongs to which sub-model: the contract of a split and the table of them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/types.hpp"

namespace moraine {

/// What a split may depend on: the scene alone, never cores or ranks.
struct SplitInput {
  std::span<const Vec3> positions;
  Vec3 gravity = Vec3::Zero();
  std::size_t parts = 1;
};

/// Returns one part number per position. Parts differ in size by at most one element; ties go by index.
/// Cost: O(n log n) times log(parts).
using Split = std::vector<SubModelId> (*)(const SplitInput& input);

struct SplitRow {
  std::string_view name;
  std::string_view help;
  Split split;
};

std::span<const SplitRow> splits();
/// The row of a name. "auto" is pillars if the scene has gravity and each would be at least 5 diameters wide, else rcb.
/// Errors: InputError that prints the table.
const SplitRow& find_split(std::string_view name, const Scene& scene, std::size_t parts);

std::vector<SubModelId> split_slabs(const SplitInput& input);
std::vector<SubModelId> split_rcb(const SplitInput& input);
std::vector<SubModelId> split_pillars(const SplitInput& input);
std::vector<SubModelId> split_curve(const SplitInput& input);

/// The axis along which a set of points is longest; the lower axis if equal.
int longest_axis(std::span<const Vec3> positions, std::span<const std::uint32_t> subset);

}  // namespace moraine
