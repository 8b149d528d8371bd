// SPDX-License-Identifier: Apache-2.0
// What a contact remembers of the impact that made it.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

#include <bit>
#include <cstdint>

#include "physics/bullet/precision.hpp"

namespace moraine::bullet {

// Bullet carries one user pointer with a contact point for as long as the point lives. It holds a number here, and no
// contact callbacks are installed that would read it.

/// Overlap [element diameters] that an impact has left and that is still to be taken back without making speed.
inline btScalar impact_overlap(const btManifoldPoint& p) {
  return std::bit_cast<btScalar>(static_cast<ScalarBits>(reinterpret_cast<std::uintptr_t>(p.m_userPersistentData)));
}

inline void set_impact_overlap(btManifoldPoint& p, btScalar overlap) {
  p.m_userPersistentData = reinterpret_cast<void*>(std::uintptr_t{std::bit_cast<ScalarBits>(overlap)});
}

}  // namespace moraine::bullet
