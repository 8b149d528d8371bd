// SPDX-License-Identifier: Apache-2.0
// Points sorted into cubic cells: near neighbours in constant time each, in an order that does not depend on history.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace moraine {

/// Counting-sort cell list over a box. Points keep their index order inside a cell. Buffers are reused between builds.
/// Points that are not finite do no harm: they are put into some cell.
/// Point: anything with operator[](0..2). Cost: linear in points and cells; cells are at most 2 per point.
template <class Real>
class CellGrid {
 public:
  using Point = std::array<Real, 3>;

  void build(std::span<const Point> points, Real cell_size) {
    measure(points, cell_size);
    count(points);
    fill(points.size());
  }

  /// Calls visit(index) for every point in the 27 cells around p (cells clamped to the box).
  template <class Visit>
  void around(const Point& p, Visit&& visit) const {
    visit_cells(clamped(p, -1), clamped(p, +1), visit);
  }

  /// Calls visit(index) for every point in the cells that the box [low, high] touches; more than those in the box.
  template <class Visit>
  void in_box(const Point& low, const Point& high, Visit&& visit) const {
    visit_cells(clamped(low, 0), clamped(high, 0), visit);
  }

 private:
  using Cell = std::array<int, 3>;

  template <class Visit>
  void visit_cells(const Cell& low, const Cell& high, Visit&& visit) const {
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) {
        const std::size_t row = (static_cast<std::size_t>(z) * size_[1] + y) * size_[0];
        for (std::uint32_t k = start_[row + low[0]]; k < start_[row + high[0] + 1]; ++k) visit(order_[k]);
      }
  }

  void measure(std::span<const Point> points, Real cell_size) {
    Point high{};
    low_.fill(std::numeric_limits<Real>::max());
    high.fill(std::numeric_limits<Real>::lowest());
    for (const Point& p : points)
      for (int a = 0; a < 3; ++a) {
        if (!std::isfinite(p[a])) continue;
        low_[a] = std::min(low_[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    if (points.empty()) low_ = high = Point{};
    Real cell = cell_size;
    const double most = 2.0 * static_cast<double>(points.size()) + 27;
    while (!fits(high, cell, most)) cell *= Real(1.26);
    inverse_ = 1 / cell;
  }

  bool fits(const Point& high, Real cell, double most) {
    double cells = 1;
    for (int a = 0; a < 3; ++a) {
      const double n = std::floor(static_cast<double>((high[a] - low_[a]) / cell)) + 1;
      cells *= n;
      if (!(cells <= most)) return false;
      size_[a] = static_cast<int>(n);
    }
    return true;
  }

  int along(Real x, int axis, int shift) const {
    const double c = std::floor(static_cast<double>((x - low_[axis]) * inverse_)) + shift;
    return c > 0 ? static_cast<int>(std::min(c, static_cast<double>(size_[axis] - 1))) : 0;
  }
  Cell clamped(const Point& p, int shift) const {
    return {along(p[0], 0, shift), along(p[1], 1, shift), along(p[2], 2, shift)};
  }

  void count(std::span<const Point> points) {
    start_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2] + 1, 0);
    cell_of_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Cell c = clamped(points[i], 0);
      cell_of_[i] = static_cast<std::uint32_t>((static_cast<std::size_t>(c[2]) * size_[1] + c[1]) * size_[0] + c[0]);
      ++start_[cell_of_[i] + 1];
    }
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  }

  void fill(std::size_t points) {
    order_.resize(points);
    cursor_.assign(start_.begin(), start_.end() - 1);
    for (std::uint32_t i = 0; i < points; ++i) order_[cursor_[cell_of_[i]]++] = i;
  }

  Point low_{};
  Real inverse_ = 1;
  std::array<int, 3> size_{1, 1, 1};
  std::vector<std::uint32_t> start_, cursor_, cell_of_, order_;
};

}  // namespace moraine
