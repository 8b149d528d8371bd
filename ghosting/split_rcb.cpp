// SPDX-License-Identifier: Apache-2.0
// Recursive coordinate bisection (Berger & Bokhari 1987), its form seen along gravity, and slabs.
#include <algorithm>
#include <numeric>

#include "ghosting/split.hpp"

namespace moraine {
namespace {

using Subset = std::span<std::uint32_t>;

/// Order along an axis; ties by the other axes in turn, so that equal columns stay together, then by index.
struct Along {
  std::span<const Vec3> positions;
  int axis;
  bool operator()(std::uint32_t i, std::uint32_t j) const {
    for (int k = 0; k < 3; ++k) {
      const double a = positions[i][(axis + k) % 3], b = positions[j][(axis + k) % 3];
      if (a != b) return a < b;
    }
    return i < j;
  }
};

std::vector<std::uint32_t> everyone(std::size_t n) {
  std::vector<std::uint32_t> all(n);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

void bisect(std::span<const Vec3> positions, Subset subset, SubModelId first, std::size_t parts,
            std::vector<SubModelId>& out) {
  if (parts <= 1) {
    for (const std::uint32_t i : subset) out[i] = first;
    return;
  }
  const std::size_t low_parts = parts / 2;
  const std::size_t cut = subset.size() * low_parts / parts;
  const Along along{positions, longest_axis(positions, subset)};
  std::nth_element(subset.begin(), subset.begin() + static_cast<std::ptrdiff_t>(cut), subset.end(), along);
  bisect(positions, subset.first(cut), first, low_parts, out);
  bisect(positions, subset.subspan(cut), first + static_cast<SubModelId>(low_parts), parts - low_parts, out);
}

}  // namespace

std::vector<SubModelId> split_rcb(const SplitInput& input) {
  std::vector<SubModelId> out(input.positions.size(), 0);
  std::vector<std::uint32_t> all = everyone(input.positions.size());
  bisect(input.positions, all, 0, input.parts, out);
  return out;
}

std::vector<SubModelId> split_pillars(const SplitInput& input) {
  const Vec3 down = input.gravity.isZero() ? Vec3(-Vec3::UnitZ()) : Vec3(input.gravity.normalized());
  std::vector<Vec3> seen_from_above;
  seen_from_above.reserve(input.positions.size());
  for (const Vec3& p : input.positions) seen_from_above.push_back(p - down * down.dot(p));
  return split_rcb({seen_from_above, input.gravity, input.parts});
}

std::vector<SubModelId> split_slabs(const SplitInput& input) {
  std::vector<SubModelId> out(input.positions.size(), 0);
  std::vector<std::uint32_t> all = everyone(input.positions.size());
  std::sort(all.begin(), all.end(), Along{input.positions, longest_axis(input.positions, all)});
  for (std::size_t k = 0; k < all.size(); ++k) out[all[k]] = static_cast<SubModelId>(k * input.parts / all.size());
  return out;
}

}  // namespace moraine
