// SPDX-License-Identifier: Apache-2.0
// Where many elements go.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "physics/types.hpp"

namespace moraine {

/// A regular packing of equal spheres. hcp: hexagonal close packing, rows along x, layers stacked along z as A B A B.
/// cubic: simple cubic packing, columns along x, y and z.
struct Lattice {
  enum class Kind { hcp, cubic };
  Kind kind = Kind::hcp;
  double diameter = 1;  ///< [m]
  double spacing = 1;   ///< between neighbours' centres [diameters]
};

/// Centres of the spheres that lie wholly inside the box, layer by layer from the bottom; at most `count` of them.
std::vector<Vec3> pack_lattice(const Lattice& lattice, const Bounds& box, std::size_t count = SIZE_MAX);
/// `cells` spheres along x, y and z, the lowest touching `corner`; at most `count` of them, from the bottom.
std::vector<Vec3> pack_lattice(const Lattice& lattice, const std::array<std::int64_t, 3>& cells, const Vec3& corner,
                               std::size_t count = SIZE_MAX);

/// Moves every point by up to `by` [m] along each axis.
void jitter(std::vector<Vec3>& points, double by, std::uint64_t seed);

/// Random sequential insertion of spheres, largest first: centres in the order of `radii`, no two spheres overlapping,
/// all inside the box. Nothing if a sphere found no place in 20,000 attempts.
/// Cost: constant per attempt while radii are alike.
std::optional<std::vector<Vec3>> pack_random(const Bounds& box, std::span<const double> radii, std::uint64_t seed);

}  // namespace moraine
