// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "physics/shape.hpp"

namespace moraine {

/// Radius of the largest ball about the centre that fits into a solid; of a compound, of its thickest part [m].
double inner_radius(const Geometry& geometry);

}  // namespace moraine
