// SPDX-License-Identifier: Apache-2.0
// Which element belongs to which sub-model: the contract of a split and the table of them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/types.hpp"

namespace moraine {

/// A split is a function of positions and part count alone, never of cores or ranks. Returns one part number per
/// position. Parts differ in size by at most one element; ties go by index. Cost: O(n log n) times log(parts).
using Split = std::vector<SubModelId> (*)(std::span<const Vec3> positions, std::size_t parts);

struct SplitRow {
  std::string_view name;
  std::string_view help;
  Split split;
};

std::span<const SplitRow> splits();
/// Errors: InputError that prints the table.
Split find_split(std::string_view name);

std::vector<SubModelId> split_slabs(std::span<const Vec3> positions, std::size_t parts);
std::vector<SubModelId> split_rcb(std::span<const Vec3> positions, std::size_t parts);
std::vector<SubModelId> split_curve(std::span<const Vec3> positions, std::size_t parts);

/// The axis along which a set of points is longest; the lower axis if equal.
int longest_axis(std::span<const Vec3> positions, std::span<const std::uint32_t> subset);

}  // namespace moraine
