// SPDX-License-Identifier: Apache-2.0
#include "physics/hull.hpp"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "physics/errors.hpp"

namespace moraine {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Owns one run of qhull and its memory.
class Qhull {
 public:
  explicit Qhull(std::vector<double>& coordinates) : sink_(std::fopen("/dev/null", "w")) {
    qh_zero(&qh_, sink_);
    char options[] = "qhull Qt";
    const int count = static_cast<int>(coordinates.size() / 3);
    failed_ = qh_new_qhull(&qh_, 3, count, coordinates.data(), False, options, sink_, sink_) != 0;
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    int current = 0, total = 0;
    qh_freeqhull(&qh_, !qh_ALL);
    qh_memfreeshort(&qh_, &current, &total);
    if (sink_) std::fclose(sink_);
  }

  bool failed() const { return failed_; }

  /// Facets as triples of point numbers, either way round.
  std::vector<Triangle> facets() {
    std::vector<Triangle> triangles;
    qhT* qh = &qh_;
    facetT* facet;
    FORALLfacets {
      Triangle t{};
      std::size_t corner = 0;
      vertexT *vertex, **vertexp;
      FOREACHvertex_(facet->vertices) {
        if (corner < 3) t[corner++] = static_cast<std::uint32_t>(qh_pointid(qh, vertex->point));
      }
      triangles.push_back(t);
    }
    return triangles;
  }

 private:
  std::FILE* sink_;
  qhT qh_{};
  bool failed_ = true;
};

void check_points(const std::vector<Vec3>& points) {
  if (points.size() < 4) {
    throw InputError("a hull of " + std::to_string(points.size()) + " points, expected at least 4");
  }
  for (const Vec3& p : points) {
    if (!p.allFinite()) throw InputError("a hull point is not finite, expected finite coordinates");
  }
}

/// About the middle and of size 1, so that the tolerances of the library suit any scale and place.
std::vector<double> unit_coordinates(const std::vector<Vec3>& points) {
  Bounds bounds;
  for (const Vec3& p : points) bounds.add(p);
  const Vec3 middle = 0.5 * (bounds.min + bounds.max);
  const double size = (bounds.max - bounds.min).maxCoeff();
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const Vec3& p : points) {
    const Vec3 unit = (p - middle) / (size > 0 ? size : 1);
    coordinates.insert(coordinates.end(), unit.data(), unit.data() + 3);
  }
  return coordinates;
}

void face_outward(HullMesh& hull) {
  Vec3 inside = Vec3::Zero();
  for (const Vec3& v : hull.vertices) inside += v / static_cast<double>(hull.vertices.size());
  for (Triangle& t : hull.triangles) {
    const Vec3 &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
    if ((b - a).cross(c - a).dot(a - inside) < 0) std::swap(t[1], t[2]);
  }
}

}  // namespace

HullMesh convex_hull(const std::vector<Vec3>& points) {
  check_points(points);
  std::vector<double> coordinates = unit_coordinates(points);
  Qhull qhull(coordinates);
  if (qhull.failed()) throw InputError("the hull's points lie in one plane, expected a solid");

  HullMesh hull;
  hull.triangles = qhull.facets();
  std::vector<std::uint32_t> number(points.size(), 0);
  for (const Triangle& t : hull.triangles) {
    for (const std::uint32_t i : t) number[i] = 1;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(hull.vertices.size());
    hull.vertices.push_back(points[i]);
  }
  for (Triangle& t : hull.triangles) {
    for (std::uint32_t& i : t) i = number[i];
  }
  face_outward(hull);
  std::sort(hull.triangles.begin(), hull.triangles.end());
  return hull;
}

}  // namespace moraine
