// SPDX-License-Identifier: Apache-2.0
// Equal pieces of a Hilbert curve through the scene's bounding cube.
#include <algorithm>
#include <array>
#include <numeric>

#include "ghosting/split.hpp"

namespace moraine {
namespace {

constexpr int bits = 20;  // per axis

/// Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707 (2004): axes to transposed Hilbert index.
void to_hilbert(std::array<std::uint32_t, 3>& x) {
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (auto& xi : x) {
      if (xi & q) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ xi) & p;
        x[0] ^= t;
        xi ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1)
    if (x[2] & q) t ^= q - 1;
  for (auto& xi : x) xi ^= t;
}

std::uint64_t interleaved(const std::array<std::uint32_t, 3>& x) {
  std::uint64_t key = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (const std::uint32_t xi : x) key = (key << 1) | ((xi >> b) & 1U);
  return key;
}

std::uint64_t hilbert_key(const Vec3& p, const Bounds& box, double edge) {
  std::array<std::uint32_t, 3> x{};
  constexpr double cells = (1U << bits) - 1;
  for (int a = 0; a < 3; ++a) x[a] = static_cast<std::uint32_t>((p[a] - box.min[a]) / edge * cells);
  to_hilbert(x);
  return interleaved(x);
}

}  // namespace

std::vector<SubModelId> split_curve(const SplitInput& input) {
  const auto& positions = input.positions;
  Bounds box;
  for (const Vec3& p : positions) box.add(p);
  const double extent = positions.empty() ? 1.0 : (box.max - box.min).maxCoeff();
  const double edge = extent > 0 ? extent : 1.0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(positions.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = {hilbert_key(positions[i], box, edge), i};
  std::sort(order.begin(), order.end());
  std::vector<SubModelId> out(positions.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    out[order[k].second] = static_cast<SubModelId>(k * input.parts / order.size());
  return out;
}

}  // namespace moraine
