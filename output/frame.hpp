// SPDX-License-Identifier: Apache-2.0
// One moment of a run, copied out of the worlds so that writing need not stop the stepping.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/types.hpp"

namespace moraine {

/// Elements ascending by id; ghosts ascending by (host, id). All arrays of a group have one length.
struct Frame {
  struct Bodies {
    std::vector<ElementId> id;
    std::vector<SubModelId> sub_model;  ///< owner of an element, host of a ghost
    std::vector<ElementState> state;
    std::vector<std::uint32_t> shape;  ///< index into Scene::shapes
    std::size_t size() const { return id.size(); }
  };
  std::int64_t step = 0;
  double time = 0;  ///< [s]
  Bodies elements;
  Bodies ghosts;
  std::vector<std::uint32_t> bonds;  ///< indices into Scene::bonds of those not broken
  std::vector<Pose> boundary_poses;  ///< one per Scene::boundaries, at this time
};

}  // namespace moraine
