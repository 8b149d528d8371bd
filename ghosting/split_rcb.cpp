// SPDX-License-Identifier: Apache-2.0
// Recursive coordinate bisection (Berger & Bokhari 1987), and slabs as its one-axis form.
#include <algorithm>
#include <numeric>

#include "ghosting/split.hpp"

namespace moraine {
namespace {

using Subset = std::span<std::uint32_t>;

struct Along {
  std::span<const Vec3> positions;
  int axis;
  bool operator()(std::uint32_t i, std::uint32_t j) const {
    const double a = positions[i][axis], b = positions[j][axis];
    return a != b ? a < b : i < j;
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

std::vector<SubModelId> split_rcb(std::span<const Vec3> positions, std::size_t parts) {
  std::vector<SubModelId> out(positions.size(), 0);
  std::vector<std::uint32_t> all = everyone(positions.size());
  bisect(positions, all, 0, parts, out);
  return out;
}

std::vector<SubModelId> split_slabs(std::span<const Vec3> positions, std::size_t parts) {
  std::vector<SubModelId> out(positions.size(), 0);
  std::vector<std::uint32_t> all = everyone(positions.size());
  std::sort(all.begin(), all.end(), Along{positions, longest_axis(positions, all)});
  for (std::size_t k = 0; k < all.size(); ++k) out[all[k]] = static_cast<SubModelId>(k * parts / all.size());
  return out;
}

}  // namespace moraine
