// SPDX-License-Identifier: Apache-2.0
// Shapes of elements and pieces of boundaries as ODE's geometries, in scaled
// units.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <span>
#include <vector>

#include "physics/native/surface.hpp"

namespace moraine::ode {

struct FreeGeom {
  void operator()(dGeomID geom) const { dGeomDestroy(geom); }
};
using Geom = std::unique_ptr<dxGeom, FreeGeom>;

/// The parts of an element's shape, fixed to its body; one unless it is a
/// compound. `scale` is 1 / length unit.
std::vector<Geom> make_parts(const Geometry& geometry, double scale, dBodyID body);

/// Triangles of one boundary, with the numbers that ODE keeps pointing to.
class Mesh {
 public:
  Mesh(std::span<const native::Surface> triangles, double scale);
  dGeomID geom() const { return geom_.get(); }

 private:
  struct FreeData {
    void operator()(dTriMeshDataID data) const { dGeomTriMeshDataDestroy(data); }
  };
  std::vector<double> corners_;
  std::vector<dTriIndex> index_;
  std::unique_ptr<dxTriMeshData, FreeData> data_;
  Geom geom_;
};

/// A piece of a boundary other than a triangle, in the boundary's frame.
Geom make_piece(const native::Surface& surface, double scale);
/// Places a piece of a boundary whose frame is at `pose` (scaled, local).
void place_piece(dGeomID geom, const native::Surface& surface, double scale, const Pose& pose);
void place(dGeomID geom, const Pose& pose);

}  // namespace moraine::ode
