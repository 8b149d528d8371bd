// SPDX-License-Identifier: Apache-2.0
#include "physics/native/sized_grid.hpp"

namespace moraine::native {

void SizedGrid::build(std::span<const Ball> balls, double margin) {
  for (Class& c : classes_) {
    c.members.clear();
    c.centres.clear();
    c.largest = 0;
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (const Ball& b : balls) smallest = std::min(smallest, b.radius);
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    if (!balls[i].centre.allFinite()) continue;  // nowhere, and near nothing
    const auto size_class = static_cast<std::size_t>(std::ilogb(balls[i].radius / smallest));
    if (size_class >= classes_.size()) classes_.resize(size_class + 1);
    Class& c = classes_[size_class];
    c.members.push_back(i);
    c.centres.push_back(point(balls[i].centre.array()));
    c.largest = std::max(c.largest, balls[i].radius);
  }
  for (Class& c : classes_)
    if (!c.members.empty()) c.grid.build(c.centres, c.largest + margin / 2);
}

}  // namespace moraine::native
