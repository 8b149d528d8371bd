// SPDX-License-Identifier: Apache-2.0
// What should hold elements: planes, closed meshes, and whatever is lowest.
#pragma once

#include <limits>
#include <vector>

#include "physics/scene/scene.hpp"

namespace moraine {

/// The boundaries of a scene as elements must not get past them. Planes hold what is on their side; a mesh all of whose
/// edges join two triangles holds what is inside, and counts as left when the box around it is. Other boundaries hold
/// nothing. `scene` must outlive it.
class Enclosure {
 public:
  Enclosure() = default;
  explicit Enclosure(const Scene& scene);

  /// Boundaries stand as prescribed for time t [s].
  void move(double t);
  /// How far a point is past the boundaries that held `start` at t = 0 [m]; 0 or less if it is not.
  double beyond(const Vec3& point, const Vec3& start) const;
  /// Whether no point of a box is past a boundary or below all of them. May say no where a point by point look says
  /// yes.
  bool holds(const Bounds& box) const;
  /// How far a point is below the lowest point of all boundaries and of all elements' starts [m]. Nothing is if there
  /// is no gravity, no boundary, or a plane that holds from below.
  double below(const Vec3& point) const { return down_.dot(point) - lowest_; }

 private:
  /// A half space or a box that is not to be left.
  struct Wall {
    const Boundary* boundary = nullptr;
    const TriangleMesh* mesh = nullptr;  ///< else a plane
    Bounds box = {};                     ///< of a mesh, in its frame
    Pose pose = {};                      ///< now
    Vec3 normal = Vec3::Zero();          ///< of a plane, now: it holds points with normal * point >= offset
    double offset = 0;

    void place(const Pose& at);
    double beyond(const Vec3& point) const;
    bool holds(const Bounds& all) const;
    bool held(const Vec3& start) const;
  };
  void find_lowest(double t);

  const Scene* scene_ = nullptr;
  std::vector<Wall> walls_;
  Vec3 down_ = Vec3::Zero();
  double first_lowest_ = 0, lowest_ = std::numeric_limits<double>::infinity();
};

}  // namespace moraine
