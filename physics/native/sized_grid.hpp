// SPDX-License-Identifier: Apache-2.0
// Balls of any size sorted into cells, one grid per size class, so that a few large ones do not make the cells large.
#pragma once

#include <vector>

#include "physics/cell_grid.hpp"
#include "physics/types.hpp"

namespace moraine::native {

/// A ball: where an element is and how far it reaches.
struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

/// Radii within a factor of two share a class. Cost of build(): linear in balls. Buffers are reused.
class SizedGrid {
 public:
  /// `margin`: what will be added to both radii in most queries; only the size of the cells follows from it.
  void build(std::span<const Ball> balls, double margin);

  std::size_t classes() const { return classes_.size(); }
  std::span<const std::uint32_t> members(std::size_t size_class) const { return classes_[size_class].members; }
  double largest_radius(std::size_t size_class) const { return classes_[size_class].largest; }

  /// Calls visit(index) for every ball of the class whose centre is within `reach` of `p` along every axis, and others.
  template <class Visit>
  void around(std::size_t size_class, const Vec3& p, double reach, Visit&& visit) const {
    const Class& c = classes_[size_class];
    if (c.members.empty()) return;
    c.grid.in_box(point(p.array() - reach), point(p.array() + reach), [&](std::uint32_t k) { visit(c.members[k]); });
  }
  /// Calls visit(index) for every ball that may come closer than `gap` to the box, and others.
  template <class Visit>
  void near_box(const Bounds& box, double gap, Visit&& visit) const {
    for (const Class& c : classes_) {
      if (c.members.empty()) continue;
      const double reach = c.largest + gap;
      c.grid.in_box(point(box.min.array() - reach), point(box.max.array() + reach),
                    [&](std::uint32_t k) { visit(c.members[k]); });
    }
  }

 private:
  using Point = CellGrid<double>::Point;
  static Point point(const Eigen::Array3d& p) { return {p.x(), p.y(), p.z()}; }

  struct Class {
    std::vector<std::uint32_t> members;  ///< ascending
    std::vector<Point> centres;
    double largest = 0;
    CellGrid<double> grid;
  };
  std::vector<Class> classes_;  ///< by rising size
};

}  // namespace moraine::native
