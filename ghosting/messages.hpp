// SPDX-License-Identifier: Apache-2.0
// What sub-models tell each other. Two messages per pair and substep: host to owner after the step, owner to host after
// the bound update.
#pragma once

#include <span>
#include <vector>

#include "ghosting/coupling.hpp"
#include "physics/types.hpp"

namespace moraine {

/// A ghost's result, for the owner. Same order as the owner's last GhostOrder list.
struct GhostResult {
  std::uint32_t element = 0;
  std::uint32_t reserved = 0;
  CopyMotion motion;
};

/// An element of the host that lies near the owner's bounds, to be searched for pairs.
struct BorderElement {
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  double radius = 0;  ///< bounding [m]
};

/// Host to owner.
struct StepMessage {
  std::vector<GhostResult> results;         ///< ascending element
  bool border_is_new = true;                ///< if not, ghosts stay as they are
  std::vector<BorderElement> border;        ///< ascending element
  std::vector<std::uint32_t> broken_bonds;  ///< ascending
  bool resting = false;                     ///< the host does not advance: the results are old ones

  void write(std::vector<std::byte>& out) const;
  void read(std::span<const std::byte> in);
};

/// A ghost that the owner wants in the host's world for the next substep.
struct GhostOrder {
  std::uint32_t element = 0;
  bool carries = false;  ///< see Body
  double share = 0;      ///< of the element's mass
  ElementState start;
};

/// Owner to host.
struct BoundMessage {
  Bounds bounds;                            ///< of the owner's elements
  double max_speed = 0;                     ///< of the owner's elements [m/s]
  std::vector<GhostOrder> ghosts;           ///< ascending element; ghosts not listed are dropped
  std::vector<std::uint32_t> broken_bonds;  ///< ascending
  bool resting = false;                     ///< the owner does not advance: the ghosts are where they were

  void write(std::vector<std::byte>& out) const;
  void read(std::span<const std::byte> in);
};

}  // namespace moraine
