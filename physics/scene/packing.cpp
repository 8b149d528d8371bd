// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/packing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/scene/random.hpp"

namespace moraine {
namespace {

constexpr int attempts_per_sphere = 20000;
constexpr std::uint32_t none = UINT32_MAX;

/// The lattice relative to the centre of its first sphere.
class Steps {
 public:
  explicit Steps(const Lattice& lattice)
      : hcp_(lattice.kind == Lattice::Kind::hcp), step_(lattice.diameter * lattice.spacing) {}

  Vec3 at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return {x_offset(j, k) + step_ * static_cast<double>(i), y_offset(k) + row() * static_cast<double>(j),
            layer() * static_cast<double>(k)};
  }
  /// Points along x, y, z that stay within `room` of the first.
  std::int64_t columns(double room, std::int64_t j, std::int64_t k) const {
    return within(room - x_offset(j, k), step_);
  }
  std::int64_t rows(double room, std::int64_t k) const { return within(room - y_offset(k), row()); }
  std::int64_t layers(double room) const { return within(room, layer()); }

 private:
  double row() const { return hcp_ ? step_ * std::sqrt(3.0) / 2 : step_; }
  double layer() const { return hcp_ ? step_ * std::sqrt(2.0 / 3.0) : step_; }
  double x_offset(std::int64_t j, std::int64_t k) const { return !hcp_ || (j + k) % 2 == 0 ? 0 : step_ / 2; }
  double y_offset(std::int64_t k) const { return !hcp_ || k % 2 == 0 ? 0 : row() / 3; }
  static std::int64_t within(double room, double step) {
    return room < -1e-9 * step ? 0 : static_cast<std::int64_t>(std::floor(room / step + 1e-9)) + 1;
  }

  bool hcp_;
  double step_;
};

/// Spheres put so far, in cells at least as wide as the largest sphere.
class InsertionGrid {
 public:
  InsertionGrid(const Bounds& box, double cell, std::size_t points) : low_(box.min) {
    const Vec3 extent = box.max - box.min;
    cell = std::max(cell, std::cbrt(extent.prod() / static_cast<double>(8 * points + 8)));
    for (int a = 0; a < 3; ++a) size_[a] = std::max<std::int64_t>(1, std::llround(std::floor(extent[a] / cell)));
    cell_ = extent.cwiseQuotient(
        Vec3(static_cast<double>(size_[0]), static_cast<double>(size_[1]), static_cast<double>(size_[2])));
    heads_.assign(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]), none);
    next_.assign(points, none);
  }

  void put(std::uint32_t index, const Vec3& point) {
    std::uint32_t& head = heads_[number(cell_of(point))];
    next_[index] = head;
    head = index;
  }

  /// Whether `test` holds for any point in the 27 cells around.
  template <class Test>
  bool any_near(const Vec3& point, const Test& test) const {
    const Cell c = cell_of(point);
    for (std::int64_t z = std::max<std::int64_t>(c[2] - 1, 0); z <= std::min(c[2] + 1, size_[2] - 1); ++z) {
      for (std::int64_t y = std::max<std::int64_t>(c[1] - 1, 0); y <= std::min(c[1] + 1, size_[1] - 1); ++y) {
        for (std::int64_t x = std::max<std::int64_t>(c[0] - 1, 0); x <= std::min(c[0] + 1, size_[0] - 1); ++x) {
          for (std::uint32_t i = heads_[number({x, y, z})]; i != none; i = next_[i]) {
            if (test(i)) return true;
          }
        }
      }
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const Vec3& point) const {
    Cell c{};
    for (int a = 0; a < 3; ++a) {
      c[static_cast<std::size_t>(a)] =
          std::clamp<std::int64_t>(static_cast<std::int64_t>((point[a] - low_[a]) / cell_[a]), 0, size_[a] - 1);
    }
    return c;
  }
  std::size_t number(const Cell& c) const {
    return static_cast<std::size_t>((c[2] * size_[1] + c[1]) * size_[0] + c[0]);
  }

  Vec3 low_, cell_;
  std::int64_t size_[3] = {1, 1, 1};
  std::vector<std::uint32_t> heads_, next_;
};

std::vector<std::uint32_t> largest_first(std::span<const double> radii) {
  std::vector<std::uint32_t> order(radii.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return radii[a] > radii[b]; });
  return order;
}

}  // namespace

std::vector<Vec3> pack_lattice(const Lattice& lattice, const Bounds& box, std::size_t count) {
  const Steps steps(lattice);
  const Vec3 room = box.max - box.min - Vec3::Constant(lattice.diameter);
  const Vec3 first = box.min + Vec3::Constant(lattice.diameter / 2);
  std::vector<Vec3> points;
  for (std::int64_t k = 0; k < steps.layers(room.z()); ++k) {
    for (std::int64_t j = 0; j < steps.rows(room.y(), k); ++j) {
      for (std::int64_t i = 0; i < steps.columns(room.x(), j, k); ++i) {
        if (points.size() == count) return points;
        points.push_back(first + steps.at(i, j, k));
      }
    }
  }
  return points;
}

std::vector<Vec3> pack_lattice(const Lattice& lattice, const std::array<std::int64_t, 3>& cells, const Vec3& corner,
                               std::size_t count) {
  const Steps steps(lattice);
  const Vec3 first = corner + Vec3::Constant(lattice.diameter / 2);
  std::vector<Vec3> points;
  for (std::int64_t k = 0; k < cells[2]; ++k) {
    for (std::int64_t j = 0; j < cells[1]; ++j) {
      for (std::int64_t i = 0; i < cells[0]; ++i) {
        if (points.size() == count) return points;
        points.push_back(first + steps.at(i, j, k));
      }
    }
  }
  return points;
}

void jitter(std::vector<Vec3>& points, double by, std::uint64_t seed) {
  Random random(seed);
  const Bounds cube{Vec3::Constant(-by), Vec3::Constant(by)};
  for (Vec3& p : points) p += random.in_box(cube);
}

std::optional<std::vector<Vec3>> pack_random(const Bounds& box, std::span<const double> radii, std::uint64_t seed) {
  std::vector<Vec3> centres(radii.size());
  if (radii.empty()) return centres;
  const std::vector<std::uint32_t> order = largest_first(radii);
  InsertionGrid grid(box, 2 * radii[order.front()], radii.size());
  Random random(seed);
  for (const std::uint32_t index : order) {
    const double radius = radii[index];
    const Bounds room = box.inflated(-radius);
    if (room.empty()) return std::nullopt;
    const auto place = [&] {
      const Vec3 p = random.in_box(room);
      const auto overlaps = [&](std::uint32_t other) {
        const double least = radius + radii[other];
        return (centres[other] - p).squaredNorm() < least * least;
      };
      if (grid.any_near(p, overlaps)) return false;
      centres[index] = p;
      grid.put(index, p);
      return true;
    };
    int attempts = 0;
    while (!place()) {
      if (++attempts == attempts_per_sphere) return std::nullopt;
    }
  }
  return centres;
}

}  // namespace moraine
